"""What must hold between the tables of cases with friction heat."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .heat import Heat
    from .schema import Case

Fault = tuple[str, str]
Need = tuple[str, str, str]

_COLD = ("fretting", "reciprocating")
"""Analyses that refuse the whole table."""


def heat(case: Case) -> Iterator[Fault]:
    """Friction heat must have somewhere to go, from where the geometry and the analysis have it."""
    heat = case.heat
    if heat is None:
        if case.analysis.type == "stability":
            yield "heat", "missing; a stability analysis asks what friction heat does"
        return
    yield from _surfaces(case, heat)
    if heat.advection != "none" and not case.geometry.passes:
        yield "heat.advection", _not_advected(case)
    elif heat.advection == "resolved" and case.motion is not None and case.motion.history:
        yield (
            "heat.advection",
            '"resolved" is for one speed, not for motion.history: use "spread" or "none"',
        )
    if case.analysis.type in _COLD:
        return
    if heat.transient and case.analysis.type != "transient":
        yield "heat.transient", f"is for a transient analysis, not for {case.analysis.type}"
    elif heat.initial is not None and not heat.transient:
        yield "heat.initial", "is for temperatures in time: heat.transient = true"


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
    """What cools, or has a given temperature."""
    lasts = not heat.transient  # a stability analysis asks for a base state that lasts
    leaves = heat.advection == "resolved" and case.geometry.rotation_center is None
    if lasts and not leaves and not heat.cooling and not heat.temperature:
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


def _not_advected(case: Case) -> str:
    moving = case.geometry.bodies[1]
    if case.geometry.sector != 1.0:
        return f"heat is spread round the {moving} already, which is modelled by its section"
    return f"{moving} does not pass under the other body, as a strip, a disk or a drum does"
