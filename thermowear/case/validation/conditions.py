"""Consistency checks of holder, loads, sliding motion and heat."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from ..any_case import AnyCase
from ..tables.conditions import HeatTable
from ..tables.geometry import Geometry
from ..tables.schema import Case
from ..values.section import Fault

_FREE = {
    "axisymmetric": ("z",),
    "plane-strain": ("x", "z", "rotation"),
    "plane-stress": ("x", "z", "rotation"),
    "3d": ("x", "y", "z", "rotation-x", "rotation-y"),
}
"""Free rigid motions of the holder by model."""
_MIRRORED = {"symmetry": ("z", "y", "rotation-x"), "rollers": ("z", "x", "rotation-y")}
"""Free motions in space by the planes of symmetry."""
_NEEDS_FREE = {
    "approach": ("z", "moves the holder along the load direction; add"),
    "tangential_force": ("x", "requires a holder that is free along x: add"),
}
"""Free motion of the holder that a load requires, and the message without it."""
_NEEDS_MODEL = {"moments": "3d", "moment": "plane", "lever": "plane"}
"""Models that a load requires."""
_ARTICLES = {"axisymmetric": "an"}
"""Articles of models in messages."""
SURFACES = ("cooling", "temperature", "flux", "power")
"""Keys of heat that are tables by surface."""
_EXCLUSIVE = (
    *((table, "temperature") for table in ("cooling", "flux", "power")),
    ("power", "flux"),
)
"""Pairs of these tables of which a surface can have only one."""


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
    if case.model == "3d":
        yield from _mirrored(case)
    elif case.geometry.symmetry and free != ("z",):
        key = "holder.free" if case.geometry.slides_across else "geometry.half"
        yield key, 'a symmetric model needs holder.free = ["z"]'
    if case.analysis.type == "fretting" and free != ("z",):
        yield (
            "holder",
            "is not supported in a fretting analysis: load.history prescribes its motion",
        )


def _mirrored(case: Case) -> Iterator[Fault]:
    """Free motions of the holder that planes of symmetry x or y = const permit."""
    for key, allowed in _MIRRORED.items():
        wrong = [name for name in case.holder.free if name not in allowed]
        if getattr(case.geometry, key) and wrong:
            yield (
                "holder.free",
                f"{wrong[0]!r} contradicts the planes of geometry.{key}, which permit "
                f"{', '.join(allowed)}",
            )


def load(case: Case) -> Iterator[Fault]:
    """One normal load, compatible with the free motions of the holder."""
    load, history, free = case.load, case.load.history, case.holder.free
    given = sum(x is not None for x in (load.force, load.mean_pressure, load.approach))
    wrong = None
    if history is not None and (history.force is not None or history.approach is not None):
        if given:
            wrong = "load.history already prescribes the force or the approach"
    elif free == ("rotation",) and load.moment is not None:
        if given or load.lever is not None or load.point is not None:
            wrong = "a holder that can only rotate needs either a moment, or a force with its lever"
    elif not free:
        if given or not (load.surfaces or load.pressure):
            wrong = (
                "a fixed holder (holder.free = []) needs load.surfaces or load.pressure, and "
                "nothing else"
            )
    elif load.surfaces:
        yield "load.surfaces", "requires a fixed holder (holder.free = [])"
    elif given > 1 or (given == 0 and not load.pressure):
        wrong = "needs exactly one of force, mean_pressure and approach"
    if wrong is not None:
        yield "load", wrong
    if load.mean_pressure is not None and case.geometry.contact_area() is None:
        yield "load.mean_pressure", "this geometry has no nominal contact area; give the force"
    if case.analysis.type == "steady":
        unloads = "no steady state, as wear unloads the contact;"
        if not free:
            yield "holder.free", f"is empty: {unloads} use a transient analysis"
        if load.approach is not None:
            yield "load.approach", f"{unloads} a steady analysis needs a force"
    if load.lever is not None and load.point is not None:
        yield "load.lever", "only one of lever and point can be given"
    for key in ("lever", "point", "moment", "moments"):
        if getattr(load, key) is not None and not case.holder.turns:
            yield f"load.{key}", "requires a holder that can rotate (holder.free)"
    for key, model in _NEEDS_MODEL.items():
        if getattr(load, key) is not None and model not in case.model:
            yield f"load.{key}", f"requires a {model} model"
    for key, (direction, text) in _NEEDS_FREE.items():
        if getattr(load, key) is not None and direction not in free:
            yield f"load.{key}", f'{text} "{direction}" to holder.free'


def surface_pressure(case: Case) -> Iterator[Fault]:
    """Pressures on surfaces that can be loaded, in analyses that support them."""
    geometry, load = case.geometry, case.load
    refused = dict.fromkeys(geometry.contact, "is a contact face, whose pressure is computed")
    refused |= dict.fromkeys(
        geometry.symmetry, "lies on a plane of symmetry, which cannot be loaded"
    )
    if case.model == "3d":
        refused |= dict.fromkeys(geometry.rollers, "is on rollers, which cannot be loaded")
        refused |= dict.fromkeys(geometry.mid_plane, "lies on a mid-plane, which cannot be loaded")
    refused[geometry.fixed] = "is fixed; a pressure on it has no effect"
    for name in load.pressure:
        if name in refused:
            yield f"load.pressure.{name}", refused[name]
    alone = load.pressure and case.force() is None and case.approach() is None
    if alone and type(geometry).expected_zone is not Geometry.expected_zone:
        yield (
            "load",
            "needs one of force, mean_pressure and approach besides load.pressure: "
            f"the mesh of {geometry.type!r} is made for their contact zone",
        )


def motion(case: Case) -> Iterator[Fault]:
    """Only the velocity component that the geometry can slide with."""
    motion, type_ = case.motion, case.analysis.type
    if motion is None or case.model not in case.geometry.models or type_ == "reciprocating":
        return
    for key in ("amplitude", "frequency"):
        if getattr(motion, key) is not None:
            yield f"motion.{key}", f"requires a reciprocating analysis, not {type_}"
    if (
        case.geometry.slides_across
        and motion.velocity is not None
        and motion.angular_velocity is None
    ):
        return  # the velocity alone defines the sliding
    axisymmetric = case.model == "axisymmetric"
    what = f"{_ARTICLES.get(case.model, 'a')} {case.model} model"
    needed, other = "velocity", "angular_velocity"
    if axisymmetric or motion.axis is not None or case.geometry.rotation_center is not None:
        needed, other = other, needed
        what = what if axisymmetric else "motion.axis" if motion.axis else case.geometry.type
    if getattr(motion, other) is not None:
        centre = ""
        if other == "angular_velocity" and case.geometry.has_key("rotation_center"):
            centre = ", or geometry.rotation_center (of the axis along z) if body 2 rotates"
        yield f"motion.{other}", f"not supported; {what} needs motion.{needed}{centre}"
    elif getattr(motion, needed) is None:
        yield f"motion.{needed}", f"missing; {what} needs it"
    elif axisymmetric and getattr(motion, needed) < 0:
        yield "motion.angular_velocity", "must be greater than 0 in an axisymmetric model"


def in_place(case: Case) -> Iterator[Fault]:
    """Axis in space that body 1 turns about: in place, across the planes of symmetry."""
    motion, geometry = case.motion, case.geometry
    if motion is None or motion.axis is None:
        return
    if case.model != "3d":
        yield "motion.axis", "requires a 3d model"
    elif geometry.passes:
        yield "motion.axis", "has no effect: body 2 rotates about geometry.rotation_center"
    along_x, along_y, _ = motion.axis.axis.direction
    for name, cut, along in (("x", geometry.symmetry, along_x), ("y", geometry.rollers, along_y)):
        if cut and abs(along) < 1.0:
            text = f"must be normal to the plane {name} = const of symmetry of the model"
            yield "motion.axis.direction", text


def heat(case: Case) -> Iterator[Fault]:
    """Heat needs a source and a sink that geometry and analysis support."""
    heat = case.heat
    if heat is None:
        if case.analysis.type == "stability":
            yield "heat", "missing; required in a stability analysis"
        return
    leaves = heat.advection == "resolved" and case.geometry.rotation_center is None
    yield from heated_surfaces(heat, case.geometry.contact, leaves)
    if heat.advection != "none" and not case.geometry.passes:
        yield "heat.advection", why_not_passing(case)
    elif heat.advection != "none" and case.motion is None:
        yield "heat.advection", "needs [motion]: without it body 2 does not pass by"
    elif heat.advection == "resolved" and case.motion is not None and case.motion.history:
        yield (
            "heat.advection",
            '"resolved" needs a constant speed, without motion.history: use "spread" or "none"',
        )
    elif heat.advection == "spread" and not case.geometry.along_paths:
        yield (
            "heat.advection",
            '"spread" needs a mesh with rows of elements along the path of body 2; the mesh of '
            f'{case.geometry.type!r} has none: use "resolved"',
        )
    yield from heat_in_time(case, heat)


def heat_in_time(case: AnyCase, heat: HeatTable) -> Iterator[Fault]:
    """Temperatures in time need a transient analysis, and their courses need them."""
    analysis = case.analysis
    if analysis.cyclic:  # do not support heat
        return
    if heat.transient and analysis.type != "transient":
        yield "heat.transient", f"requires a transient analysis, not {analysis.type}"
    elif not heat.transient:
        keys = [] if heat.initial is None else ["initial"]
        if analysis.type == "transient":  # the others have no histories at all
            keys += heat.histories
        for key in keys:
            yield f"heat.{key}", "requires temperatures in time: heat.transient = true"


def heated_surfaces(heat: HeatTable, faces: Collection[str], leaves: bool) -> Iterator[Fault]:
    """Thermal boundary conditions: heat sink, and at most one condition per surface.

    Parameters
    ----------
    heat : HeatTable
    faces : collection of str
        Contact faces.
    leaves : bool
        True if a body carries heat out of the model.
    """
    lasts = not heat.transient  # a stability analysis needs a steady base state
    if lasts and not leaves and not heat.cooling and not heat.temperature:
        yield "heat", "needs heat.cooling or heat.temperature: there is no heat sink"
    if heat.ambient_history is not None and not heat.cooling and not leaves:
        yield "heat.ambient_history", "has no effect: no surface has heat.cooling"
    for table, taken in _EXCLUSIVE:
        for name in getattr(heat, table):
            if name in getattr(heat, taken):
                yield f"heat.{table}.{name}", f"this surface already has a prescribed {taken}"
    for table in SURFACES:
        for name in getattr(heat, table):
            if name in faces:
                text = "a contact face exchanges heat with the other body only"
                yield f"heat.{table}.{name}", text


def may_pass(case: Case) -> bool:
    """True if body 2 of a mesh file passes under body 1 once the file's case says how."""
    return case.geometry.from_file and case.model != "axisymmetric"


def why_not_passing(case: Case) -> str:
    """Why body 2 does not pass under body 1, and what makes it so."""
    geometry, moving = case.geometry, case.geometry.bodies[1]
    if geometry.sector != 1.0:
        return f"heat is already distributed around the {moving}, which is modelled by its section"
    if not may_pass(case):
        return f"{moving} does not pass under the other body, as a strip, a disk or a drum does"
    key = "rotation_center (its axis)" if case.model == "3d" else "track (its length)"
    return f"{moving} passes under the other body only with geometry.{key}"
