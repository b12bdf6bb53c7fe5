"""What must hold between the tables of a case.

Every check yields the path of the key at fault and what is wrong there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from ..errors import CaseError
from .materials import resolve_like
from .oscillation import fretting, reciprocating

if TYPE_CHECKING:
    from .schema import Case

Fault = tuple[str, str]

_FREE = {
    "axisymmetric": ("z",),
    "plane-strain": ("x", "z", "rotation"),
    "plane-stress": ("x", "z", "rotation"),
    "3d": ("x", "y", "z", "rotation-x", "rotation-y"),
}
"""Motions of the holder by model."""


def check(case: Case) -> None:
    """Raise a `CaseError` that lists every fault between the tables of `case`."""
    faults = [f"{path}: {text}" for look in _CHECKS for path, text in look(case)]
    if faults:
        raise CaseError(*faults)


def _names(case: Case) -> Iterator[Fault]:
    """Bodies and surfaces must be those of the geometry."""
    bodies, surfaces = case.geometry.bodies, case.geometry.surfaces
    yield from _unknown("bodies", case.bodies, case.geometry.parts)
    yield from _unknown("wear", case.wear, bodies)
    yield from _unknown("mesh.bodies", case.mesh.bodies, bodies)
    yield from _unknown("load.surfaces", case.load.surfaces, surfaces)
    for name in bodies:
        if name not in case.bodies:
            yield f"bodies.{name}", "missing; every body of the geometry needs its material"
    if case.heat is not None:
        yield from _unknown("heat.cooling", case.heat.cooling, surfaces)
        yield from _unknown("heat.temperature", case.heat.temperature, surfaces)


def _unknown(table: str, found: Iterable[str], known: tuple[str, ...]) -> Iterator[Fault]:
    for name in found:
        if name not in known:
            yield f"{table}.{name}", f"not a name of this geometry; one of: {', '.join(known)}"


def _model(case: Case) -> Iterator[Fault]:
    if case.model not in case.geometry.models:
        yield "model", f"{case.model!r} does not fit; allowed: {', '.join(case.geometry.models)}"


def _materials(case: Case) -> Iterator[Fault]:
    needed = {"young_modulus": "", "poisson_ratio": ""}
    if case.heat is not None:
        why = " because the case has a [heat] table"
        needed |= {"conductivity": why, "expansion": why}
    for name, body in case.bodies.items():
        if name not in case.geometry.parts:
            continue
        if body.like is not None:
            for key in sorted(body.model_fields_set - {"like"}):
                yield f"bodies.{name}.{key}", "a body that is like another has no keys of its own"
            try:
                resolve_like(case.bodies, name)
            except ValueError as error:
                yield f"bodies.{name}.like", str(error)
            continue
        for key, why in needed.items():
            if getattr(body, key) is None:
                yield f"bodies.{name}.{key}", f"missing; needed{why}"


def _holder(case: Case) -> Iterator[Fault]:
    free, dim = case.holder.free, len(case.geometry.press_direction)
    allowed = _FREE.get(case.model, ())
    for name in free:
        if name not in allowed:
            yield "holder.free", f"{name!r} is not for {case.model}; one of: {', '.join(allowed)}"
    pivot, point = case.holder.pivot, case.load.point
    if pivot is not None and len(pivot) != dim:
        yield "holder.pivot", f"has {len(pivot)} coordinates; {case.model} needs {dim}"
    if point is not None and len(point) != dim - 1:
        yield "load.point", f"has {len(point)} coordinates; {case.model} needs {dim - 1}"
    if case.geometry.symmetry and free != ("z",):
        yield "geometry.half", "only a holder that moves along the press is symmetric"
    if case.analysis.type == "fretting" and free != ("z",):
        yield "holder", "is not for a fretting analysis: its history says how it moves"


def _load(case: Case) -> Iterator[Fault]:
    load, history, free = case.load, case.load.history, case.holder.free
    given = [x is not None for x in (load.force, load.mean_pressure, load.approach)]
    turns_only = free == ("rotation",)
    if history is not None and (history.force is not None or history.approach is not None):
        if sum(given) > 0:
            yield "load", "the history gives the force or the approach already"
    elif turns_only and load.moment is not None:
        if sum(given) > 0 or load.lever is not None or load.point is not None:
            yield "load", "a holder that only turns needs a moment, or a force and its lever"
    elif not free:
        if sum(given) > 0 or not load.surfaces:
            yield "load", "a fixed holder (holder.free = []) needs load.surfaces, and nothing else"
    elif load.surfaces:
        yield "load.surfaces", "is for a fixed holder (holder.free = [])"
    elif sum(given) != 1:
        yield "load", "needs exactly one of force, mean_pressure and approach"
    if load.mean_pressure is not None and case.geometry.contact_area() is None:
        yield "load.mean_pressure", "this geometry has no nominal contact area; give the force"
    if not free and case.analysis.type == "steady":
        yield "holder.free", "is empty: nothing presses in the end; use a transient analysis"
    if load.approach is not None and case.analysis.type == "steady":
        yield "load.approach", "nothing presses in the end; the steady state needs a force"
    if load.approach is not None and "z" not in free:
        yield "load.approach", 'moves the holder along the press; add "z" to holder.free'
    if load.lever is not None and load.point is not None:
        yield "load.lever", "says with load.point twice where the force acts"
    for key in ("lever", "point", "moment", "moments"):
        if getattr(load, key) is not None and not case.holder.turns:
            yield f"load.{key}", "is for a holder that may turn (holder.free)"
    needs = {"moments": "3d", "moment": "plane", "lever": "plane"}
    for key, model in needs.items():
        if getattr(load, key) is not None and model not in case.model:
            yield f"load.{key}", f"is for {model} models"
    if load.tangential_force is not None and "x" not in free:
        yield "load.tangential_force", 'is for a holder that is free along it: holder.free = ["x"…]'


def _motion(case: Case) -> Iterator[Fault]:
    if case.motion is None or case.model not in case.geometry.models:
        return
    if case.analysis.type == "reciprocating":  # see `oscillation`
        return
    for key in ("amplitude", "frequency"):
        if getattr(case.motion, key) is not None:
            yield f"motion.{key}", f"is for a reciprocating analysis, not for {case.analysis.type}"
    across = case.geometry.slides_across and case.motion.velocity is not None
    if across and case.motion.angular_velocity is None:
        return  # the speed along which it slides is all it needs
    turns = case.model == "axisymmetric" or case.geometry.rotation_center is not None
    needed, other = "angular_velocity", "velocity"
    if not turns:
        needed, other = other, needed
    what = "axisymmetric models" if case.model == "axisymmetric" else case.geometry.type
    what = what if turns else f"{case.model} models"
    given = getattr(case.motion, needed)
    if getattr(case.motion, other) is not None:
        yield f"motion.{other}", f"does not fit; {what} needs motion.{needed}"
    elif given is None:
        yield f"motion.{needed}", f"missing; {what} needs it"
    elif case.model == "axisymmetric" and given < 0:
        yield "motion.angular_velocity", "must be greater than 0 in an axisymmetric model"


def _sliding(case: Case) -> Iterator[Fault]:
    wears = case.analysis.type in ("steady", "transient", "reciprocating")
    if wears and not case.wear:
        yield "wear", f"missing; a {case.analysis.type} analysis needs the wear law of a body"
    slides = case.analysis.type != "fretting" and (wears or case.heat is not None)
    if slides and case.motion is None:
        yield "motion", "missing; wear and friction heat need sliding"
    if case.contact.friction == 0.0:
        if case.heat is not None:
            yield "contact.friction", "is 0; friction heat needs friction"
        for name, law in case.wear.items():
            if law.per == "friction-stress":
                yield (
                    "contact.friction",
                    f'is 0; wear.{name} is per friction stress (write per = "pressure" instead)',
                )


def _spread(case: Case) -> Iterator[Fault]:
    moving = case.geometry.bodies[1]
    for name, law in case.wear.items():
        if law.spread == "in-place":
            continue
        if name != moving:
            yield f"wear.{name}.spread", f"only {moving} passes under the other body"
        elif case.geometry.track is None and case.geometry.sector == 1.0:
            yield f"wear.{name}.spread", f"all of {moving} is in the contact all the time"
        elif case.analysis.type in ("fretting", "reciprocating"):
            yield f"wear.{name}.spread", f"nothing passes by in a {case.analysis.type} analysis"
        elif case.analysis.type == "steady" and len(case.wear) == 1 and case.geometry.sector == 1.0:
            yield (
                f"wear.{name}.spread",
                "wear along a track alone evens nothing out: no steady state",
            )


def _heat(case: Case) -> Iterator[Fault]:
    heat = case.heat
    if heat is None:
        return
    if not heat.cooling and not heat.temperature:
        yield "heat", "needs cooling or a given temperature: the friction heat has nowhere to go"
    for name in heat.cooling:
        if name in heat.temperature:
            yield f"heat.cooling.{name}", "this surface has a given temperature already"
    for table, found in (("cooling", heat.cooling), ("temperature", heat.temperature)):
        for name in found:
            if name in case.geometry.contact:
                yield (
                    f"heat.{table}.{name}",
                    "a contact face exchanges heat with the other body only",
                )


def _degrees(case: Case) -> Iterator[Fault]:
    own = case.contact.pressure_degree
    if isinstance(own, int) and own > case.mesh.degree:
        yield "contact.pressure_degree", f"found {own}; at most mesh.degree = {case.mesh.degree}"


def _method(case: Case) -> Iterator[Fault]:
    keys = {"penalty": "penalty", "theta": "nitsche", "gamma": "nitsche"}
    for key, method in keys.items():
        if getattr(case.contact, key) is not None and case.contact.method != method:
            yield f"contact.{key}", f'is for method = "{method}"'


def _in_space(case: Case) -> Iterator[Fault]:
    if case.model != "3d":
        return
    if case.contact.method != "condensed":
        yield "contact.method", f"{case.contact.method!r} is for sections; use condensed in 3d"
    if case.contact.transverse_friction > 0 or case.contact.pressure_degree == "lobatto":
        key = "transverse_friction" if case.contact.transverse_friction > 0 else "pressure_degree"
        yield f"contact.{key}", "is for sections, not for 3d"
    if case.geometry.initial_shape is not None:
        yield "geometry.initial_shape", "is a curve along a section; not for 3d"
    if case.analysis.type not in ("initial", "steady", "transient"):
        yield "analysis.type", f"{case.analysis.type!r} is for sections, not for 3d"


def _positioning(case: Case) -> Iterator[Fault]:
    if case.contact.positioning and not case.geometry.follows_contact:
        yield "contact.positioning", f"the mesh of {case.geometry.type!r} cannot be moved"
    elif case.contact.positioning and getattr(case.geometry, "zone", None) is not None:
        yield "contact.positioning", "moves the mesh to the unworn contact; leave out geometry.zone"


def _symmetry(case: Case) -> Iterator[Fault]:
    drags = case.contact.friction > 0 and case.motion is not None
    if drags and case.model != "axisymmetric" and case.geometry.symmetry:
        yield "geometry.half", "sliding friction is not symmetric; mesh the whole section"


_CHECKS = (
    _names,
    _model,
    _materials,
    _holder,
    _load,
    _motion,
    reciprocating,
    _sliding,
    _spread,
    fretting,
    _heat,
    _degrees,
    _method,
    _in_space,
    _positioning,
    _symmetry,
)
