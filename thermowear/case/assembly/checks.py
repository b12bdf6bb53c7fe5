"""Consistency checks between the tables of a case of several bodies.

Every check yields the path of the key at fault and a message.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...errors import CaseError
from ...laws.motions import spans
from ..values.section import Fault
from .schema import AssemblyCase
from .stability import check_stability
from .tables import SUPPORTS, AssemblyHolderTable

_NAME, _AT = re.compile(r"[\w-]+"), "_at_"
"""Names of contacts are parts of file names; a time follows the latter."""
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
                yield path, f"found {surface!r}; {_unknown(geometry.surfaces)}"


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
            yield f"contacts.{name}", "the name must consist of letters, digits, - and _"
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


def _is_number(name: str) -> bool:
    try:
        float(name)
    except ValueError:
        return False
    return True


def _holders(case: AssemblyCase) -> Iterator[Fault]:
    """Every body has one holder, or supports; somewhere it is pressed."""
    holders = dict[str, str]()
    dim = 3 if case.model == "3d" else 2
    for name, holder in case.holders.items():
        for key in ("direction", "point", "pivot"):
            given = getattr(holder, key)
            if given is not None and len(given) != dim:
                yield f"holders.{name}.{key}", f"has {len(given)} coordinates; needs {dim}"
        for motion in holder.free:
            if motion in ("y", "rotation-x", "rotation-y") and dim == 2:
                yield f"holders.{name}.free", f"{motion!r} is a motion in space"
            if case.model == "axisymmetric" and motion != "z":
                yield f"holders.{name}.free", f"{motion!r} is not possible in this model"
        for surface in holder.surface:
            body = case.geometry.body_of(surface)
            if body in holders:
                yield f"holders.{name}.surface", f"{body} is on holders.{holders[body]}, too"
            holders[body] = name
            if case.bodies[body].fixed:
                yield f"bodies.{body}.fixed", f"{body} is on holders.{name}"
    loads = [
        h.force or h.approach or h.closing_moment or any(h.moments or ()) or h.history
        for h in case.holders.values()
    ]
    if not any(loads) and not case.load.pressure and case.heat is None:
        yield "holders", "nothing is pressed: one of them needs a force, a moment or an approach"


def _reactions(case: AssemblyCase) -> Iterator[Fault]:
    """Another holder that moves along the force bears it."""
    for name, holder in case.holders.items():
        if holder.reaction is None:
            continue
        path, other = f"holders.{name}.reaction", case.holders.get(holder.reaction)
        if other is None:
            known = ", ".join(one for one in case.holders if one != name)
            yield path, f"found {holder.reaction!r}; must be another holder: {known or 'none'}"
        elif other is holder:
            yield path, "a holder cannot bear its own force; name another one"
        elif holder.force is None and (holder.history is None or holder.history.force is None):
            yield path, f"needs a force to bear: holders.{name}.force"
        elif len(_direction(case, other)) == len(_direction(case, holder)) and not spans(
            _translations(case, other), _direction(case, holder)
        ):
            text = "is not free along this force (free, direction), or has an approach"
            yield path, f"the holder {holder.reaction!r} {text}"


def _direction(case: AssemblyCase, holder: AssemblyHolderTable) -> tuple[float, ...]:
    """Load direction, of any length."""
    return holder.direction or case.geometry.press_direction(holder.surface[0])


def _translations(case: AssemblyCase, holder: AssemblyHolderTable) -> list[tuple[float, ...]]:
    """Directions of the translations along which a force moves a holder."""
    along = _direction(case, holder)
    axes = {name: tuple(float(i == k) for i in range(len(along))) for k, name in enumerate("xy")}
    free = [along] if "z" in holder.free and holder.approach is None else []
    return free + [axes[name] for name in holder.free if name in axes]


def _motions(case: AssemblyCase) -> Iterator[Fault]:
    """Motions fit the model, and wear and friction heat need them."""
    for name, motion in case.motions.items():
        plane = case.model not in ("axisymmetric", "3d")
        if case.model == "axisymmetric" and motion.angular_velocity is None:
            yield f"motions.{name}.angular_velocity", "missing; an axisymmetric model needs it"
        if motion.across and not plane:
            yield f"motions.{name}.across", "is for plane models"
    if case.analysis.type == "steady" and not case.wear:
        yield "wear", "missing; a steady analysis needs the wear law of a body"
    heated = case.heat is not None and not case.heat.driven
    if not case.motions and (case.wear or heated) and not case.analysis.cyclic:
        yield "motions", "missing; wear and friction heat need a sliding body: [motions.NAME]"


def _wear(case: AssemblyCase) -> Iterator[Fault]:
    """Wear laws fit the friction of the contacts of their body."""
    for name, table in case.wear.items():
        if table.spread == "track" and not _passes(case, name):
            text = "is for rings that pass a sector (geometry.rings) and for a turning drum"
            yield f"wear.{name}.spread", text
    for path, law in case.wear.laws.items():
        name = path.partition(".materials.")[0]
        for joint, contact in case.contacts.items():
            own = name in map(case.geometry.body_of, contact.between or ())
            per_friction = law.rate is None and law.per == "friction-stress"
            if own and per_friction and not contact.tie and contact.nominal_friction == 0.0:
                yield (
                    f"contacts.{joint}.friction",
                    f'is 0; wear.{path} is per friction stress (write per = "pressure" instead)',
                )


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
    """Heat needs a sink, and one condition a surface."""
    heat = case.heat
    if heat is None:
        return
    if case.analysis.cyclic:
        yield "heat", f"is not supported in a {case.analysis.type} analysis"
        return
    faces = {face for contact in case.contacts.values() for face in contact.between or ()}
    for key in _ON_SURFACES:
        for surface in getattr(heat, key):
            if surface in faces:
                text = "a contact face exchanges heat with the other body only"
                yield f"heat.{key}.{surface}", text
    if not heat.transient and not heat.cooling and not heat.temperature:
        yield "heat", "needs heat.cooling or heat.temperature: there is no heat sink"
    if heat.transient and case.analysis.type != "transient":
        yield "heat.transient", f"requires a transient analysis, not {case.analysis.type}"
    passing = [motion for motion in case.motions.values() if not motion.across]
    if heat.advection != "none" and (case.model == "axisymmetric" or len(passing) != 1):
        yield (
            "heat.advection",
            "is for one moving body that passes the others in the model, as a drum or a strip does",
        )
    elif heat.advection == "resolved" and passing[0].history is not None:
        text = '"resolved" needs a constant speed, without a history: use "spread" or "none"'
        yield "heat.advection", text


_CHECKS = (
    _contacts,
    _holders,
    _reactions,
    _motions,
    _wear,
    _materials,
    _heat,
    check_stability,
)
