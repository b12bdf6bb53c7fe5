"""Consistency checks between the tables of a case.

Every check yields the path of the key at fault and a message.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ...errors import CaseError, note
from ..tables.analyses import Transient
from ..tables.materials import Properties
from ..tables.schema import Case
from .courses import courses
from .equilibrium import holder, load, motion, surface_pressure
from .heating import SURFACES, Need, heat, thermal_needs
from .oscillation import counted, fretting, reciprocating
from .varying import condensed_only, varying

Fault = tuple[str, str]

_LOCKING = {1: 0.45, 2: 0.499}
"""Largest Poisson ratio by degree, measured for a cylinder on a block with 16 elements in
contact: up to this value the error of the force is at most twice that at 0.3; no limit from
degree 3 on."""

_SLIDING = ("steady", "transient", "reciprocating")
"""Analyses of wear by sliding."""


def check(case: Case) -> None:
    """Raise a `CaseError` that lists every inconsistency between the tables of `case`.

    A consistent case is also checked for a contact zone that fits the bodies, and unusual
    defaults are noted.
    """
    faults = [f"{path}: {text}" for look in _CHECKS for path, text in look(case)]
    if faults:
        raise CaseError(*faults)
    zone = case.geometry.expected_zone(case.pressing())
    if zone is not None:
        case.geometry.check_zone(zone)
    _note_defaults(case)


def _note_defaults(case: Case) -> None:
    """Note defaults that change the result and are often set differently."""
    friction = case.contact.nominal_friction
    for name, law in case.wear.items():
        power = law.rate is None
        if power and "per" not in law.model_fields_set and friction > 0.0:
            note(
                f"wear.{name}.per is left out: the coefficient multiplies mu p (friction stress); "
                'Archard\'s k multiplies p: with per = "pressure" it wears '
                f"{friction**-law.pressure_exponent:.3g} times as fast"
            )


def _names(case: Case) -> Iterator[Fault]:
    """Bodies and surfaces must be defined by the geometry."""
    bodies, surfaces = case.geometry.bodies, case.geometry.surfaces
    named = tuple(part for part in case.geometry.parts if part not in case.geometry.set_of)
    yield from _unknown("bodies", case.bodies, named)
    yield from _unknown("wear", case.wear, bodies)
    yield from _unknown("mesh.bodies", case.mesh.bodies, bodies)
    yield from _unknown("load.surfaces", case.load.surfaces, surfaces)
    yield from _unknown("load.pressure", case.load.pressure, surfaces)
    for name in bodies:
        if name not in case.bodies:
            yield f"bodies.{name}", "missing; every body of the geometry needs a material"
    if case.heat is not None:
        for table in SURFACES:
            yield from _unknown(f"heat.{table}", getattr(case.heat, table), surfaces)


def _unknown(table: str, found: Iterable[str], known: tuple[str, ...]) -> Iterator[Fault]:
    for name in found:
        if name not in known:
            yield (
                f"{table}.{name}",
                f"unknown name in this geometry; must be one of: {', '.join(known)}",
            )


def _model(case: Case) -> Iterator[Fault]:
    if case.model not in case.geometry.models:
        yield "model", f"{case.model!r} does not fit; allowed: {', '.join(case.geometry.models)}"


def _locking(case: Case) -> Iterator[Fault]:
    """Volumetric locking of low-order elements at nearly constant volume."""
    limit = _LOCKING.get(case.mesh.degree)
    if limit is None or case.model == "plane-stress":
        return
    for name, body in case.bodies.items():
        sets = {f"{name}.materials.{key}": table for key, table in body.materials.items()}
        for path, table in {name: body, **sets}.items():
            if table.poisson_ratio is not None and table.poisson_ratio > limit:
                yield (
                    f"bodies.{path}.poisson_ratio",
                    f"found {table.poisson_ratio:g}; elements of mesh.degree = {case.mesh.degree} "
                    f"lock (become too stiff) above {limit:g}; use mesh.degree = 3 or more",
                )


def _materials(case: Case) -> Iterator[Fault]:
    geometry, sources = case.geometry, {}
    for part in geometry.parts:
        name = part if part in case.bodies else geometry.zones.get(part, part)
        if name not in case.bodies:
            continue
        path = f"bodies.{name}"
        table: Properties = case.bodies[name]
        in_set = geometry.set_of.get(part)
        if in_set is not None:
            path, table = f"{path}.materials.{in_set}", case.bodies[name].materials[in_set]
        own = part == name or in_set is not None
        if table.like is not None and own:
            for key in sorted(table.model_fields_set - {"like", "materials"}):
                yield f"{path}.{key}", "not allowed together with like"
        try:
            sources[part] = case.located_material(part)
        except ValueError as error:
            if own:
                yield f"{path}.like", str(error)
    missing: dict[str, str] = {}
    for part, key, why in _required_properties(case):
        if part in sources and getattr(sources[part][1], key) is None:
            missing.setdefault(f"{sources[part][0]}.{key}", f"missing; needed{why}")
    yield from missing.items()


def _cell_sets(case: Case) -> Iterator[Fault]:
    """Materials by cell set require bodies of a mesh file, with a material for each cell."""
    geometry = case.geometry
    for name, body in case.bodies.items():
        if body.materials and not geometry.set_of:
            yield (
                f"bodies.{name}.materials",
                f'needs cell sets of a mesh file (geometry.type = "file"), found {geometry.type!r}',
            )
        elif body.materials and name in geometry.bodies and not body.has_own:
            named = {geometry.set_of[part] for part in geometry.parts_of(name)[1:]}
            for left in geometry.sets_of(name):
                if left not in named:
                    yield (
                        f"bodies.{name}.young_modulus",
                        f"missing; cells of {left!r} may be in no set of bodies.{name}.materials",
                    )


def _required_properties(case: Case) -> Iterator[Need]:
    """Parts, keys of their material that are required, and the reason."""
    for part in case.geometry.parts:
        yield from ((part, key, "") for key in ("young_modulus", "poisson_ratio"))
    yield from thermal_needs(case)


def _sliding(case: Case) -> Iterator[Fault]:
    analysis = case.analysis
    if not case.wear and _computes_wear(case):
        yield "wear", f"missing; a {analysis.type} analysis needs the wear law of a body"
    heated_by_friction = analysis.type == "stability" or (
        case.heat is not None and not case.heat.driven
    )
    if case.motion is None and analysis.type != "fretting":
        yield from _at_rest(case, heated_by_friction)
    if case.contact.nominal_friction == 0.0:
        if heated_by_friction:
            yield "contact.friction", "is 0; friction heat needs friction"
        for name, law in case.wear.items():
            if law.rate is not None and "mu" in law.variables:
                yield "contact.friction", f"is 0; wear.{name}.rate depends on mu"
            elif law.rate is None and law.per == "friction-stress":
                yield (
                    "contact.friction",
                    f'is 0; wear.{name} is per friction stress (write per = "pressure" instead)',
                )


def _at_rest(case: Case, heated_by_friction: bool) -> Iterator[Fault]:
    """Without sliding there is neither wear nor friction heat, only conduction."""
    type_ = case.analysis.type
    if _computes_wear(case) or type_ == "stability" or (case.wear and type_ in _SLIDING):
        text = "missing; wear and friction heat need sliding"
        if case.heat is not None and not heated_by_friction:
            text += (
                '; for conduction at rest use analysis.type = "initial", or "transient" with '
                "heat.transient = true and without wear"
            )
        yield "motion", text
    elif heated_by_friction:
        yield (
            "motion",
            "missing; no heat source: needs sliding, or heat.temperature, heat.flux or heat.power",
        )


def _computes_wear(case: Case) -> bool:
    """True if the analysis computes wear; a transient thermal one may have none."""
    analysis, heat = case.analysis, case.heat
    if isinstance(analysis, Transient) and analysis.until is None and heat is not None:
        return not heat.transient
    return analysis.type in _SLIDING


def _spread(case: Case) -> Iterator[Fault]:
    moving = case.geometry.bodies[1]
    for name, law in case.wear.items():
        if law.spread == "in-place":
            continue
        if name != moving:
            yield f"wear.{name}.spread", f"only {moving} passes under the other body; leave it out"
        elif not case.geometry.passes and case.geometry.sector == 1.0:
            yield (
                f"wear.{name}.spread",
                f"the whole face of {moving} is always in contact; leave it out",
            )
        elif case.analysis.type in ("fretting", "reciprocating"):
            yield (
                f"wear.{name}.spread",
                f"not supported in a {case.analysis.type} analysis: body 2 does not pass by",
            )
        elif case.analysis.type == "steady" and len(case.wear) == 1 and case.geometry.sector == 1.0:
            yield (
                f"wear.{name}.spread",
                "no unique steady pressure: wear spread uniformly along the track does not "
                "constrain it",
            )


def _degrees(case: Case) -> Iterator[Fault]:
    own = case.contact.pressure_degree
    if isinstance(own, int) and own > case.mesh.degree:
        yield "contact.pressure_degree", f"found {own}; at most mesh.degree = {case.mesh.degree}"


def _method(case: Case) -> Iterator[Fault]:
    keys = {"penalty": "penalty", "theta": "nitsche", "gamma": "nitsche"}
    for key, method in keys.items():
        if getattr(case.contact, key) is not None and case.contact.method != method:
            yield f"contact.{key}", f'requires method = "{method}"'
    refused = condensed_only(case)
    if refused is not None and case.contact.method != "condensed" and case.model != "3d":
        yield "contact.method", f"{case.contact.method!r} does not support {refused}; use condensed"


def _in_space(case: Case) -> Iterator[Fault]:
    if case.model != "3d":
        return
    if case.contact.method != "condensed":
        yield "contact.method", f"{case.contact.method!r} does not support 3d models; use condensed"
    if case.contact.transverse_friction > 0 or case.contact.pressure_degree == "lobatto":
        key = "transverse_friction" if case.contact.transverse_friction > 0 else "pressure_degree"
        yield f"contact.{key}", "not supported in 3d models"
    if case.analysis.type in ("fretting", "reciprocating"):
        yield "analysis.type", f"{case.analysis.type!r} is not supported in 3d models"


def _positioning(case: Case) -> Iterator[Fault]:
    if case.contact.positioning and not case.geometry.follows_contact:
        yield "contact.positioning", f"the mesh of {case.geometry.type!r} cannot be moved"
    elif case.contact.positioning and getattr(case.geometry, "zone", None) is not None:
        yield (
            "contact.positioning",
            "moves the mesh to the contact zone of the unworn faces; leave out geometry.zone",
        )


def _symmetry(case: Case) -> Iterator[Fault]:
    geometry = case.geometry
    slides = case.motion is not None and not geometry.slides_across
    drags = slides and case.contact.nominal_friction > 0
    if drags and case.model != "axisymmetric" and geometry.symmetry:
        yield "geometry.half", "sliding friction is not symmetric; mesh the whole section"


def _update(case: Case) -> Iterator[Fault]:
    """Intervals of geometry updates in analyses without geometry updates."""
    if case.wear.update in ("auto", "never"):
        return
    if case.analysis.type != "transient":
        yield (
            "wear.update",
            f"geometry updates are not supported in a {case.analysis.type} analysis",
        )


_CHECKS = (
    _names,
    _model,
    _cell_sets,
    _materials,
    _locking,
    holder,
    load,
    surface_pressure,
    courses,
    motion,
    counted,
    reciprocating,
    _sliding,
    _spread,
    _update,
    fretting,
    heat,
    varying,
    _degrees,
    _method,
    _in_space,
    _positioning,
    _symmetry,
)
