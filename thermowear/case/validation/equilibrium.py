"""Consistency checks of holder, loads and sliding motion."""

from __future__ import annotations

from collections.abc import Iterator

from ..tables.geometry import Geometry
from ..tables.schema import Case
from .faults import Fault

_FREE = {
    "axisymmetric": ("z",),
    "plane-strain": ("x", "z", "rotation"),
    "plane-stress": ("x", "z", "rotation"),
    "3d": ("x", "y", "z", "rotation-x", "rotation-y"),
}
"""Free rigid motions of the holder by model."""


def holder(case: Case) -> Iterator[Fault]:
    """Free motions supported by the model; points and pivots with its dimension."""
    free, dim = case.holder.free, len(case.geometry.press_direction)
    allowed = _FREE.get(case.model, ())
    for name in free:
        if name not in allowed:
            yield (
                "holder.free",
                f"{name!r} is not supported in {case.model} models; must be one of: "
                f"{', '.join(allowed)}",
            )
    pivot, point = case.holder.pivot, case.load.point
    if pivot is not None and len(pivot) != dim:
        yield "holder.pivot", f"has {len(pivot)} coordinates; {case.model} needs {dim}"
    if point is not None and len(point) != dim - 1:
        yield "load.point", f"has {len(point)} coordinates; {case.model} needs {dim - 1}"
    if case.geometry.symmetry and free != ("z",):
        key = "holder.free" if case.geometry.slides_across else "geometry.half"
        yield key, 'a symmetric model needs holder.free = ["z"]'
    if case.analysis.type == "fretting" and free != ("z",):
        yield (
            "holder",
            "is not supported in a fretting analysis: load.history prescribes its motion",
        )


def load(case: Case) -> Iterator[Fault]:
    """One normal load, compatible with the free motions of the holder."""
    load, history, free = case.load, case.load.history, case.holder.free
    given = [x is not None for x in (load.force, load.mean_pressure, load.approach)]
    turns_only = free == ("rotation",)
    if history is not None and (history.force is not None or history.approach is not None):
        if sum(given) > 0:
            yield "load", "load.history already prescribes the force or the approach"
    elif turns_only and load.moment is not None:
        if sum(given) > 0 or load.lever is not None or load.point is not None:
            yield (
                "load",
                "a holder that can only rotate needs either a moment, or a force with its lever",
            )
    elif not free:
        if sum(given) > 0 or not (load.surfaces or load.pressure):
            yield (
                "load",
                "a fixed holder (holder.free = []) needs load.surfaces or load.pressure, and "
                "nothing else",
            )
    elif load.surfaces:
        yield "load.surfaces", "requires a fixed holder (holder.free = [])"
    elif sum(given) > 1 or (sum(given) == 0 and not load.pressure):
        yield "load", "needs exactly one of force, mean_pressure and approach"
    if load.mean_pressure is not None and case.geometry.contact_area() is None:
        yield "load.mean_pressure", "this geometry has no nominal contact area; give the force"
    if not free and case.analysis.type == "steady":
        yield (
            "holder.free",
            "is empty: no steady state, as wear unloads the contact; use a transient analysis",
        )
    if load.approach is not None and case.analysis.type == "steady":
        yield (
            "load.approach",
            "no steady state, as wear unloads the contact; a steady analysis needs a force",
        )
    if load.approach is not None and "z" not in free:
        yield "load.approach", 'moves the holder along the load direction; add "z" to holder.free'
    if load.lever is not None and load.point is not None:
        yield "load.lever", "only one of lever and point can be given"
    for key in ("lever", "point", "moment", "moments"):
        if getattr(load, key) is not None and not case.holder.turns:
            yield f"load.{key}", "requires a holder that can rotate (holder.free)"
    needs = {"moments": "3d", "moment": "plane", "lever": "plane"}
    for key, model in needs.items():
        if getattr(load, key) is not None and model not in case.model:
            yield f"load.{key}", f"requires a {model} model"
    if load.tangential_force is not None and "x" not in free:
        yield (
            "load.tangential_force",
            'requires a holder that is free along x: add "x" to holder.free',
        )


def surface_pressure(case: Case) -> Iterator[Fault]:
    """Pressures on surfaces that can be loaded, in analyses that support them."""
    geometry, load = case.geometry, case.load
    refused = dict.fromkeys(geometry.contact, "is a contact face, whose pressure is computed")
    refused |= dict.fromkeys(
        geometry.symmetry, "lies on a plane of symmetry, which cannot be loaded"
    )
    refused[geometry.fixed] = "is fixed; a pressure on it has no effect"
    for name in load.pressure:
        if name in refused:
            yield f"load.pressure.{name}", refused[name]
    if not load.pressure:
        return
    if case.analysis.type == "fretting":
        yield "load.pressure", "is not supported in a fretting analysis"
    alone = case.force() is None and case.approach() is None
    if alone and type(geometry).expected_zone is not Geometry.expected_zone:
        yield (
            "load",
            "needs one of force, mean_pressure and approach besides load.pressure: "
            f"the mesh of {geometry.type!r} is made for their contact zone",
        )


def motion(case: Case) -> Iterator[Fault]:
    """Only the velocity component that the geometry can slide with."""
    if case.motion is None or case.model not in case.geometry.models:
        return
    if case.analysis.type == "reciprocating":  # see `oscillation`
        return
    for key in ("amplitude", "frequency"):
        if getattr(case.motion, key) is not None:
            yield f"motion.{key}", f"requires a reciprocating analysis, not {case.analysis.type}"
    across = case.geometry.slides_across and case.motion.velocity is not None
    if across and case.motion.angular_velocity is None:
        return  # the velocity alone defines the sliding
    turns = case.model == "axisymmetric" or case.geometry.rotation_center is not None
    needed, other = "angular_velocity", "velocity"
    if not turns:
        needed, other = other, needed
    what = "axisymmetric models" if case.model == "axisymmetric" else case.geometry.type
    what = what if turns else f"{case.model} models"
    given = getattr(case.motion, needed)
    if getattr(case.motion, other) is not None:
        yield f"motion.{other}", f"not supported; {what} needs motion.{needed}"
    elif given is None:
        yield f"motion.{needed}", f"missing; {what} needs it"
    elif case.model == "axisymmetric" and given < 0:
        yield "motion.angular_velocity", "must be greater than 0 in an axisymmetric model"
