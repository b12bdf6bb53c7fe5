"""Coated bush that a shaft wears through: balance of the volumes, and closed forms."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ....reference.coatings import CoatedBush
from ....results import InterfaceFields, Result
from ...check import Check, compare, computed, starter

STARTER = "shaft-in-bush-coated"
BALANCE = "linear laws: ∫ w_c n dA/k_c + ∫ w_s n dA/k_s = F s, n: part along the load"
RIGID = "rigid bodies with a clearance: closed form"
FORCES = "equilibrium"
_STIFF = ("bodies.bush.young_modulus=1.1 TPa", "bodies.shaft.young_modulus=2.1 TPa")
"""Ten times the moduli."""
_NARROW = (
    "geometry.bush_clearance=2 mm",
    "geometry.zone=1 mm",
    "contact.friction=0",
    "wear.bush.layers.thickness=['1 um']",
    "analysis.end_time=720 s",
    "analysis.output_times=[]",
)
"""Contact so narrow that all pressures are along the load."""


def bush_of(case: Any) -> CoatedBush:
    """Closed form of a case."""
    geometry, law = case.geometry, case.wear["bush"]
    return CoatedBush(
        radius=geometry.shaft_radius,
        length=geometry.thickness,
        clearance=geometry.bush_clearance,
        thickness=law.layers.thickness[0],
        coating=law.layers.each(law)[0].coefficient_si(),
        substrate=law.coefficient_si(),
        force=case.load.force,
        friction=case.contact.nominal_friction,
    )


def coated_bush() -> Iterator[Check]:
    """Volumes at all times, wear-through, and equilibrium; stiff bodies; a narrow contact."""
    case, stiff = starter(STARTER), starter(STARTER, *_STIFF)
    yield from _compared(case, computed(case), "", 2e-2)
    yield from _compared(stiff, computed(stiff), ", stiff bodies", 1e-2)
    narrow = starter(STARTER, *_NARROW)
    result, bush = computed(narrow), bush_of(narrow)
    coating, substrate = result.summary["layer_volumes_1_m3"]
    found = coating / bush.coating + substrate / bush.substrate
    known = bush.force * _distance(narrow, result.history[-1].time)
    quantity = "V_c/k_c + V_s/k_s, narrow contact [N m]"
    yield compare(quantity, found, known, 5e-3, "linear laws: F s")


def _compared(case: Any, result: Result, note: str, allowed: float) -> Iterator[Check]:
    """Balances, and what the deformation of the bodies changes little."""
    bush, times = bush_of(case), [*result.outputs, result.history[-1].time]
    states = [*result.outputs.values(), result.interface]
    for time, i in zip(times, states, strict=True):
        along, distance = i.weight * _upward(case, i), _distance(case, time)
        worn = along @ i.wear_1.clip(0.0, bush.thickness) / bush.coating
        worn += along @ (i.wear_1 - bush.thickness).clip(0.0) / bush.substrate
        after = f"after {distance:.4g} m{note}"
        quantity = f"volumes over coefficients, along the load, {after} [N m]"
        yield compare(quantity, worn, bush.force * distance, 1e-8, BALANCE)
        quantity = f"force along the load {after} [N]"
        yield compare(quantity, along @ i.pressure, bush.force, 1e-8, FORCES)
        quantity = f"largest depth {after} [m]"
        yield compare(quantity, i.wear_1.max(), bush.depth(distance), allowed, RIGID)
    found = result.summary["worn_through_distance_1_m"]
    yield compare(f"sliding distance of wear-through{note} [m]", found, bush.begin, allowed, RIGID)
    volumes = zip(
        ("coating", "substrate"),
        result.summary["layer_volumes_1_m3"],
        bush.volumes(_distance(case, times[-1])),
        strict=True,
    )
    for name, volume, known in volumes:
        yield compare(f"volume of the {name}{note} [m³]", volume, known, allowed, RIGID)


def _upward(case: Any, points: InterfaceFields) -> np.ndarray:
    """Part along the load of the traction of a unit pressure on the shaft, with friction."""
    angle = np.arctan2(points.x, case.geometry.shaft_radius - points.y)
    drag = case.contact.nominal_friction * np.sign(case.motion.angular_velocity)
    return np.cos(angle) - drag * np.sin(angle)


def _distance(case: Any, time: float) -> float:
    """Sliding distance [m]."""
    return abs(case.motion.angular_velocity) * case.geometry.shaft_radius * time
