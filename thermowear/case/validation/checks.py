"""Consistency checks between the tables of a case.

Every check yields the path of the key at fault and a message.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...errors import CaseError, note
from ..tables.analyses import Transient
from ..tables.materials import SQUEEZED, check_pressure
from ..tables.schema import Case
from ..values.section import Fault
from . import analyses, conditions, materials
from .cyclic_assembly import NO_DIRECTION
from .defaults import note_defaults
from .layer_wear import layer_wear
from .mesh_sizes import mesh_sizes
from .part_wear import note_default_per, part_wear
from .probes import probes

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
    _check_loads(case)
    zone = case.geometry.expected_zone(case.pressing())
    if zone is not None:
        case.geometry.check_zone(zone)
    friction = case.contact.nominal_friction
    cut = case.model == "3d" and (case.geometry.symmetry or case.geometry.rollers)
    if cut and case.geometry.rotation_center is not None and friction > 0.0:
        note(
            "geometry: planes of symmetry cut a sector from rotating bodies; the shear of "
            "friction, which twists the whole ring, is left out (its heat and wear are not)"
        )
    for name, law in case.wear.laws.items():
        note_default_per(name, law, friction)
    note_defaults(case)


def _check_loads(case: Case) -> None:
    """Reject loads that do not leave strains small; those on meshes of files once these are read.

    Contacts that grow with the load are rejected by their zone.
    """
    geometry, load = case.geometry, case.load
    for name, pressure in load.pressure.items():
        check_pressure(f"load.pressure.{name}", pressure, "", case)
    if geometry.from_file:
        return
    force = (case.force() or 0.0) + sum(load.surfaces.values())
    if area := geometry.bearing_area():
        check_pressure("load", force / area, " on the projected contact area", case)
    approach, size = case.approach() or 0.0, max(geometry.sizes().values(), default=math.inf)
    if approach > SQUEEZED * size:
        raise CaseError(
            f"load: an approach of {1e3 * approach:.4g} mm is {approach / size:.0%} of the largest "
            "size of the bodies (check the units)"
        )


def _names(case: Case) -> Iterator[Fault]:
    """Bodies and surfaces must be defined by the geometry."""
    bodies, surfaces = case.geometry.bodies, case.geometry.surfaces
    zoned = tuple(part for part in case.geometry.parts if part not in case.geometry.set_of)
    tables = {
        "bodies": (case.bodies, zoned),
        "wear": (case.wear, bodies),
        "mesh.bodies": (case.mesh.bodies, bodies),
        "load.surfaces": (case.load.surfaces, surfaces),
        "load.pressure": (case.load.pressure, surfaces),
    }
    for table in conditions.SURFACES if case.heat is not None else ():
        tables[f"heat.{table}"] = (getattr(case.heat, table), surfaces)
    for table, (found, known) in tables.items():
        for name in found:
            if name in known:
                continue
            text = f"unknown name in this geometry; must be one of: {', '.join(known)}"
            if known == surfaces and case.geometry.not_listed(name):
                text = (
                    "in the file, but not listed: add it to geometry.surfaces: "
                    f"{name} = {name!r}; listed are: {', '.join(known)}"
                )
            yield f"{table}.{name}", text
    for name in bodies:
        if name not in case.bodies:
            yield f"bodies.{name}", "missing; every body of the geometry needs a material"


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
        for name, law in case.wear.laws.items():
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
    geometry, moving, type_ = case.geometry, case.geometry.bodies[1], case.analysis.type
    for name, law in case.wear.items():
        why = None
        if law.spread == "in-place":
            continue
        if name != moving:
            why = f"only {moving} passes under the other body; leave it out"
        elif not geometry.passes and geometry.sector == 1.0:
            why = f"the whole face of {moving} is always in contact; leave it out"
            if conditions.may_pass(case):
                why = conditions.why_not_passing(case)
        elif case.analysis.cyclic:
            why = f"not supported in a {type_} analysis: body 2 does not pass by"
        elif type_ == "steady" and len(case.wear) == 1 and geometry.sector == 1.0:
            why = (
                "no unique steady pressure: wear spread uniformly along the track does not "
                "constrain it"
            )
        if why is not None:
            yield f"wear.{name}.spread", why


def _contact(case: Case) -> Iterator[Fault]:
    contact, own = case.contact, case.contact.pressure_degree
    if isinstance(own, int) and own > case.mesh.degree:
        yield "contact.pressure_degree", f"found {own}; at most mesh.degree = {case.mesh.degree}"
    for key, method in {"penalty": "penalty", "theta": "nitsche", "gamma": "nitsche"}.items():
        if getattr(contact, key) is not None and contact.method != method:
            yield f"contact.{key}", f'requires method = "{method}"'


def _in_space(case: Case) -> Iterator[Fault]:
    if case.model != "3d":
        return
    if case.contact.transverse_friction > 0 and case.analysis.type == "fretting":
        yield "contact.transverse_friction", NO_DIRECTION
    elif case.contact.pressure_degree == "lobatto":
        yield "contact.pressure_degree", "not supported in 3d models"


def _moving_mesh(case: Case) -> Iterator[Fault]:
    """Positioning and geometry updates need a mesh that can be moved in this analysis."""
    if case.contact.positioning and not case.geometry.follows_contact:
        yield "contact.positioning", f"the mesh of {case.geometry.type!r} cannot be moved"
    elif case.contact.positioning and getattr(case.geometry, "zone", None) is not None:
        yield (
            "contact.positioning",
            "moves the mesh to the contact zone of the unworn faces; leave out geometry.zone",
        )
    if case.wear.update not in ("auto", "never") and case.analysis.type != "transient":
        yield (
            "wear.update",
            f"geometry updates are not supported in a {case.analysis.type} analysis",
        )


def _symmetry(case: Case) -> Iterator[Fault]:
    geometry = case.geometry
    slides = case.motion is not None and not geometry.slides_across
    drags = slides and case.contact.nominal_friction > 0
    if case.model == "3d":
        along_x = case.motion is not None and case.motion.axis is None
        if drags and along_x and geometry.symmetry and geometry.rotation_center is None:
            yield (
                "geometry.symmetry",
                "sliding friction along x is not symmetric about a plane x = const; planes "
                "y = const (rollers) are possible",
            )
    elif drags and case.model != "axisymmetric" and geometry.symmetry:
        yield "geometry.half", "sliding friction is not symmetric; mesh the whole section"


_CHECKS = (
    _names,
    _model,
    mesh_sizes,
    materials.cell_sets,
    materials.like_alone,
    materials.materials,
    materials.locking,
    conditions.holder,
    conditions.load,
    conditions.surface_pressure,
    analyses.supported,
    analyses.histories,
    conditions.motion,
    conditions.in_place,
    analyses.cycles,
    analyses.reciprocating,
    _sliding,
    _spread,
    part_wear,
    layer_wear,
    analyses.fretting,
    conditions.heat,
    analyses.varying,
    _contact,
    analyses.condensed_only,
    _in_space,
    _moving_mesh,
    _symmetry,
    probes,
)
