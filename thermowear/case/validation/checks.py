"""Consistency checks between the tables of a case.

Every check yields the path of the key at fault and a message.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ...errors import CaseError, note
from ..tables.analyses import Transient
from ..tables.schema import Case
from .courses import courses
from .equilibrium import holder, load, motion, surface_pressure
from .faults import Fault
from .heating import SURFACES, heat
from .materials import cell_sets, locking, materials
from .oscillation import counted, fretting, reciprocating
from .varying import condensed_only, varying

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
    cell_sets,
    materials,
    locking,
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
