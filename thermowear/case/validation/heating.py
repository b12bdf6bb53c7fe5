"""What must hold between the tables of cases with heat."""

from __future__ import annotations

from collections.abc import Iterator

from ..tables.heat import Heat
from ..tables.schema import Case

Fault = tuple[str, str]
Need = tuple[str, str, str]

SURFACES = ("cooling", "temperature", "flux", "power")
"""Keys of heat that are tables by surface."""
_COLD = ("fretting", "reciprocating")
"""Analyses that refuse the whole table."""


def heat(case: Case) -> Iterator[Fault]:
    """Heat must come from somewhere, and go somewhere, by what geometry and analysis allow."""
    heat = case.heat
    if heat is None:
        if case.analysis.type == "stability":
            yield "heat", "missing; a stability analysis asks what friction heat does"
        return
    yield from _surfaces(case, heat)
    if heat.advection != "none" and not case.geometry.passes:
        yield "heat.advection", _not_advected(case)
    elif heat.advection != "none" and case.motion is None:
        yield "heat.advection", "needs [motion]: nothing passes by without"
    elif heat.advection == "resolved" and case.motion is not None and case.motion.history:
        yield (
            "heat.advection",
            '"resolved" is for one speed, not for motion.history: use "spread" or "none"',
        )
    if case.analysis.type in _COLD:
        return
    if heat.transient and case.analysis.type != "transient":
        yield "heat.transient", f"is for a transient analysis, not for {case.analysis.type}"
    elif not heat.transient:
        keys = [] if heat.initial is None else ["initial"]
        if case.analysis.type == "transient":  # the others have no histories at all
            keys += heat.histories
        for key in keys:
            yield f"heat.{key}", "is for temperatures in time: heat.transient = true"


def thermal_needs(case: Case) -> Iterator[Need]:
    """Parts, the keys of their material that heat needs, and why."""
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


def _surfaces(case: Case, heat: Heat) -> Iterator[Fault]:
    """What heats, cools, or has a given temperature."""
    lasts = not heat.transient  # a stability analysis asks for a base state that lasts
    leaves = heat.advection == "resolved" and case.geometry.rotation_center is None
    if lasts and not leaves and not heat.cooling and not heat.temperature:
        yield "heat", "needs cooling or a given temperature: the heat has nowhere to go"
    if heat.ambient_history is not None and not heat.cooling and not leaves:
        yield "heat.ambient_history", "changes nothing: no surface has heat.cooling"
    for table in ("cooling", "flux", "power"):
        for name in getattr(heat, table):
            if name in heat.temperature:
                yield f"heat.{table}.{name}", "this surface has a given temperature already"
    for name in heat.power:
        if name in heat.flux:
            yield f"heat.power.{name}", "this surface has a given flux already"
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
        return f"heat is spread round the {moving} already, which is modelled by its section"
    return f"{moving} does not pass under the other body, as a strip, a disk or a drum does"
