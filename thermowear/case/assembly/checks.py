"""Consistency checks between the tables of a case of several bodies.

Every check yields the path of the key at fault and a message.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...errors import CaseError
from ..values.section import Fault
from . import holders
from .schema import AssemblyCase
from .stability import check_stability
from .tables import SUPPORTS

_NAME, _AT = re.compile(r"[\w-]+"), "_at_"
"""Names of contacts are parts of file names; a time follows the latter."""
_THERMAL = ("conductance", "gap_conductance", "partition")
_ON_SURFACES = ("cooling", "temperature", "flux", "power")


def check(case: AssemblyCase) -> None:
    """Raise a `CaseError` that lists every inconsistency between the tables of a case."""
    faults = [f"{path}: {text}" for path, text in _names(case)]
    if not faults:
        faults = [f"{path}: {text}" for look in _CHECKS for path, text in look(case)]
    if faults:
        raise CaseError(*faults)


def _names(case: AssemblyCase) -> Iterator[Fault]:
    """Bodies and surfaces must be defined by the geometry."""
    geometry, known = case.geometry, set(case.geometry.surfaces)
    if case.model not in geometry.models:
        yield "model", f"{case.model!r} does not fit; allowed: {', '.join(geometry.models)}"
    bodies: dict[str, object] = {
        "wear": case.wear,
        "motions": case.motions,
        "mesh.bodies": case.mesh.bodies,
    }
    for table, names in bodies.items():
        for name in names:  # type: ignore[attr-defined]
            if name not in geometry.bodies:
                yield f"{table}.{name}", _unknown(geometry.bodies)
    for name in case.bodies:
        if name not in geometry.parts:
            yield f"bodies.{name}", _unknown(geometry.parts)
    for name in geometry.bodies:
        if name not in case.bodies:
            yield f"bodies.{name}", "missing; every body of the geometry needs a material"
    for path, surfaces in _surfaces(case):
        for surface in surfaces:
            if surface not in known:
                text = _unknown(geometry.surfaces)
                if geometry.not_listed(surface):
                    text = "in the file, but not listed: add it to geometry.surfaces.BODY"
                yield path, f"found {surface!r}; {text}"


def _surfaces(case: AssemblyCase) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Surfaces named in the case, with the paths of their keys."""
    for name, contact in case.contacts.items():
        if contact.between is None and name not in case.geometry.contacts:
            yield f"contacts.{name}.between", ("",)
        else:
            yield f"contacts.{name}.between", contact.between or ()
    for name, holder in case.holders.items():
        yield f"holders.{name}.surface", holder.surface
    for name, body in case.bodies.items():
        for key in SUPPORTS:
            yield f"bodies.{name}.{key}", getattr(body, key)
    yield "load.pressure", tuple(case.load.pressure)
    if case.heat is not None:
        for key in _ON_SURFACES:
            yield f"heat.{key}", tuple(getattr(case.heat, key))


def _unknown(known: tuple[str, ...]) -> str:
    return f"unknown name in this geometry; must be one of: {', '.join(known)}"


def _contacts(case: AssemblyCase) -> Iterator[Fault]:
    """Contacts join two bodies, and every body is at one."""
    geometry, seen, reached = case.geometry, dict[str, str](), set[str]()
    if not case.contacts:
        yield "contacts", "missing; needs the faces that touch: [contacts.NAME] between = [...]"
    for name, contact in case.contacts.items():
        if not _NAME.fullmatch(name) or _AT in name or _is_number(name):
            yield (
                f"contacts.{name}",
                "the name must consist of letters, digits, - and _, and be no number",
            )
        one, other = contact.between or ("", "")
        if geometry.body_of(one) == geometry.body_of(other):
            yield f"contacts.{name}.between", "both faces belong to the same body"
        reached |= {geometry.body_of(one), geometry.body_of(other)}
        for face in (one, other):
            if face in seen:
                yield f"contacts.{name}.between", f"{face!r} is in contacts.{seen[face]}, too"
            seen[face] = name
    for body in geometry.bodies:
        if case.contacts and body not in reached:
            yield "contacts", f"the body {body!r} touches no other one"
    if case.contacts and not case.sliding:
        yield "contacts", "all are glued (tie = true); needs one that slides"
    yield from _thermal(case)


def _thermal(case: AssemblyCase) -> Iterator[Fault]:
    """Keys of contacts that need heat."""
    for name, contact in case.contacts.items() if case.heat is None else ():
        for key in _THERMAL:
            if getattr(contact, key) is not None:
                yield f"contacts.{name}.{key}", "has no effect without a [heat] table"


def _is_number(name: str) -> bool:
    try:
        float(name)
    except ValueError:
        return False
    return True


def _motions(case: AssemblyCase) -> Iterator[Fault]:
    """Motions fit the model, and wear and friction heat need them."""
    for name, motion in case.motions.items():
        plane = case.model not in ("axisymmetric", "3d")
        if case.model == "axisymmetric" and motion.angular_velocity is None:
            yield f"motions.{name}.angular_velocity", "missing; an axisymmetric model needs it"
        if motion.across and not plane:
            yield f"motions.{name}.across", "is for plane models"
        elif motion.across and motion.angular_velocity is not None:
            yield f"motions.{name}.across", "needs a velocity, not angular_velocity"
        if motion.axis is not None and case.model != "3d":
            yield f"motions.{name}.axis", "requires a 3d model"
        about = motion.angular_velocity is not None and case.model != "axisymmetric"
        about = about and motion.axis is None
        if any(motion.center) and not about:
            text = "has no effect: only bodies in a section or in space rotate about it"
            yield f"motions.{name}.center", text
    yield from _moving_together(case)
    if case.analysis.type == "steady" and not case.wear:
        yield "wear", "missing; a steady analysis needs the wear law of a body"
    heated = case.heat is not None and not case.heat.driven
    if not case.motions and (case.wear or heated) and not case.analysis.cyclic:
        yield "motions", "missing; wear and friction heat need a sliding body: [motions.NAME]"


def _moving_together(case: AssemblyCase) -> Iterator[Fault]:
    """Glued bodies that slide have the same motion."""
    slides = case.sliding_bodies | case.motions.keys()
    for body, motion in case.motions.items():
        for mate in sorted(case.glued[body] & slides):
            twice = mate in case.motions and mate < body
            if case.motions.get(mate) != motion and not twice:
                yield f"motions.{mate}", f"must be that of {body}: glued bodies move as one"


def _wear(case: AssemblyCase) -> Iterator[Fault]:
    """Wear laws fit the friction of the contacts of their body."""
    for name, table in case.wear.items():
        if case.sliding and name not in case.sliding_bodies:
            yield f"wear.{name}", "has no effect: all contacts of this body are glued"
        if table.spread == "track" and not _passes(case, name):
            text = "is for rings that pass a sector (geometry.rings) and for a turning drum"
            yield f"wear.{name}.spread", text
    for path, law in case.wear.laws.items():
        name = path.partition(".materials.")[0]
        for joint, contact in case.contacts.items():
            own = name in map(case.geometry.body_of, contact.between or ())
            per_friction = law.rate is None and law.per == "friction-stress"
            if not own or contact.tie or contact.nominal_friction > 0.0:
                continue
            if per_friction:
                yield (
                    f"contacts.{joint}.friction",
                    f'is 0; wear.{path} is per friction stress (write per = "pressure" instead)',
                )
            elif law.rate is not None and "mu" in law.variables:
                yield f"contacts.{joint}.friction", f"is 0; wear.{path}.rate depends on mu"


def _passes(case: AssemblyCase, body: str) -> bool:
    """Test for a body with a track that passes its contacts."""
    geometry = case.geometry
    faces = [face for contact in case.contacts.values() for face in contact.between or ()]
    own = [face for face in faces if geometry.body_of(face) == body]
    tracks = all(geometry.track(face) is not None for face in own)
    return body in geometry.rings or (tracks and body in case.motions)


def _materials(case: AssemblyCase) -> Iterator[Fault]:
    """All properties that the analysis requires."""
    missing = dict[str, str]()
    for part in case.geometry.parts:
        try:
            path, material = case.located_material(part)
        except ValueError as error:
            yield f"bodies.{part}.like", str(error)
            continue
        for key, why in _needed(case, part).items():
            if getattr(material, key) is None:
                missing[f"{path}.{key}"] = f"missing; needed{why}"
    yield from missing.items()


def _needed(case: AssemblyCase, part: str) -> dict[str, str]:
    """Properties that a part must have, and why."""
    needed, storing = {"young_modulus": "", "poisson_ratio": ""}, ("density", "specific_heat")
    heat = case.heat
    if heat is None or case.analysis.cyclic:
        return needed
    needed |= dict.fromkeys(("conductivity", "expansion"), " because the case has a [heat] table")
    if heat.transient:
        needed |= dict.fromkeys(storing, " because of heat.transient")
    elif heat.advection == "resolved" and case.geometry.zones.get(part, part) in case.motions:
        needed |= dict.fromkeys(storing, ' because heat.advection is "resolved"')
    return needed


def _heat(case: AssemblyCase) -> Iterator[Fault]:
    """Advection is by one body that passes the others."""
    heat = case.heat
    if heat is None:
        return
    if case.analysis.cyclic:
        yield "heat", f"is not supported in a {case.analysis.type} analysis"
        return
    passing = [motion for motion in case.motions.values() if not motion.across]
    in_place = case.model == "axisymmetric" or any(motion.axis is not None for motion in passing)
    if heat.advection != "none" and (in_place or len(passing) != 1):
        yield (
            "heat.advection",
            "is for one moving body that passes the others in the model, as a drum or a strip does",
        )
    elif heat.advection == "resolved" and passing[0].history is not None:
        text = '"resolved" needs a constant speed, without a history: use "spread" or "none"'
        yield "heat.advection", text


_CHECKS = (
    _contacts,
    holders.held,
    holders.fitting,
    holders.loads,
    holders.planes,
    holders.reactions,
    _motions,
    _wear,
    _materials,
    _heat,
    check_stability,
)
