"""Consistency checks of cases with heat."""

from __future__ import annotations

from collections.abc import Iterator

from ..tables.heat import HeatTable
from ..tables.schema import Case
from .faults import Fault

Need = tuple[str, str, str]

SURFACES = ("cooling", "temperature", "flux", "power")
"""Keys of heat that are tables by surface."""
_COLD = ("fretting", "reciprocating")
"""Analyses that do not support heat."""


def heat(case: Case) -> Iterator[Fault]:
    """Heat needs a source and a sink that geometry and analysis support."""
    heat = case.heat
    if heat is None:
        if case.analysis.type == "stability":
            yield "heat", "missing; required in a stability analysis"
        return
    yield from _surfaces(case, heat)
    if heat.advection != "none" and not case.geometry.passes:
        yield "heat.advection", _not_advected(case)
    elif heat.advection != "none" and case.motion is None:
        yield "heat.advection", "needs [motion]: without it body 2 does not pass by"
    elif heat.advection == "resolved" and case.motion is not None and case.motion.history:
        yield (
            "heat.advection",
            '"resolved" needs a constant speed, without motion.history: use "spread" or "none"',
        )
    if case.analysis.type in _COLD:
        return
    if heat.transient and case.analysis.type != "transient":
        yield "heat.transient", f"requires a transient analysis, not {case.analysis.type}"
    elif not heat.transient:
        keys = [] if heat.initial is None else ["initial"]
        if case.analysis.type == "transient":  # the others have no histories at all
            keys += heat.histories
        for key in keys:
            yield f"heat.{key}", "requires temperatures in time: heat.transient = true"


def thermal_needs(case: Case) -> Iterator[Need]:
    """Parts, keys of their material that heat requires, and the reason."""
    heat, geometry = case.heat, case.geometry
    if heat is None:
        return
    storing = ("density", "specific_heat")
    facing = tuple(part for part in geometry.facing if part is not None)
    wanted: list[tuple[tuple[str, ...], tuple[str, ...], str]] = [
        (geometry.parts, ("conductivity", "expansion"), "the case has a [heat] table")
    ]
    if heat.transient:
        wanted.append((geometry.parts, storing, "heat.transient is true"))
    if heat.advection == "resolved":
        wanted.append(
            (geometry.parts_of(geometry.bodies[1]), storing, 'heat.advection is "resolved"')
        )
    if heat.partition == "effusivity":
        wanted.append((facing, storing, 'heat.partition is "effusivity"'))
    if getattr(heat.conductance, "type", None) == "pressure":
        wanted.append((facing, ("hardness",), 'heat.conductance is of type "pressure"'))
    for parts, keys, why in wanted:
        yield from ((part, key, f" because {why}") for part in parts for key in keys)


def _surfaces(case: Case, heat: HeatTable) -> Iterator[Fault]:
    """Thermal boundary conditions: heat sink, and at most one condition per surface."""
    lasts = not heat.transient  # a stability analysis needs a steady base state
    leaves = heat.advection == "resolved" and case.geometry.rotation_center is None
    if lasts and not leaves and not heat.cooling and not heat.temperature:
        yield "heat", "needs heat.cooling or heat.temperature: there is no heat sink"
    if heat.ambient_history is not None and not heat.cooling and not leaves:
        yield "heat.ambient_history", "has no effect: no surface has heat.cooling"
    for table in ("cooling", "flux", "power"):
        for name in getattr(heat, table):
            if name in heat.temperature:
                yield f"heat.{table}.{name}", "this surface already has a prescribed temperature"
    for name in heat.power:
        if name in heat.flux:
            yield f"heat.power.{name}", "this surface already has a prescribed flux"
    for table in SURFACES:
        for name in getattr(heat, table):
            if name in case.geometry.contact:
                yield (
                    f"heat.{table}.{name}",
                    "a contact face exchanges heat with the other body only",
                )


def _not_advected(case: Case) -> str:
    moving = case.geometry.bodies[1]
    if case.geometry.sector != 1.0:
        return f"heat is already distributed around the {moving}, which is modelled by its section"
    return f"{moving} does not pass under the other body, as a strip, a disk or a drum does"
