"""Coated bush that a shaft wears through: balance of the volumes, and closed forms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ....case import Case
from ....reference.coated_bush import CoatedBush
from ....results import InterfaceFields, Result
from ...check import Check, compare, computed, starter

STARTER = "shaft-in-bush-coated"
BALANCE = "linear laws: ∫ w_c n dA/k_c + ∫ w_s n dA/k_s = F s, n: part along the load"
RIGID = "rigid bodies with a clearance: closed form"
FORCES = "equilibrium"
_NARROW = (
    "geometry.bush_clearance=2 mm",
    "geometry.zone=1 mm",
    "contact.friction=0",
    "wear.bush.layers.thickness=['1 um']",
    "analysis.end_time=720 s",
    "analysis.output_times=[]",
)
"""Contact so narrow that all pressures are along the load."""


def bush_of(case: Case) -> CoatedBush:
    """Closed form of a case."""
    geometry, law = case.geometry, case.wear["bush"]
    assert law.layers is not None
    return CoatedBush(
        radius=geometry.shaft_radius,
        length=geometry.thickness,
        clearance=geometry.bush_clearance,
        thickness=law.layers.thickness[0],
        coating=law.layers.coefficient[0],
        substrate=law.coefficient,
        force=case.load.force,
        friction=case.contact.nominal_friction,
    )


def upward(case: Case, points: InterfaceFields) -> np.ndarray:
    """Part along the load of the traction of a unit pressure, with friction."""
    angle = np.arctan2(points.x, case.geometry.shaft_radius - points.y)
    drag = case.contact.nominal_friction * np.sign(case.motion.angular_velocity)
    return np.cos(angle) - drag * np.sin(angle)


def coated_bush() -> Iterator[Check]:
    """Volumes at all times, time of wear-through, and equilibrium; a narrow contact."""
    case = starter(STARTER)
    yield from _compared(case, computed(case), "")
    narrow = starter(STARTER, *_NARROW)
    result = computed(narrow)
    yield from _compared(narrow, result, ", narrow contact")
    bush = bush_of(narrow)
    coating, substrate = result.summary["layer_volumes_1_m3"]
    found = coating / bush.coating + substrate / bush.substrate
    known = bush.force * _distance(narrow, result.history[-1].time)
    quantity = "V_c/k_c + V_s/k_s, narrow contact [N m]"
    yield compare(quantity, found, known, 5e-3, "linear laws: F s")


def _compared(case: Case, result: Result, note: str) -> Iterator[Check]:
    bush, times = bush_of(case), [*result.outputs, result.history[-1].time]
    states = [*result.outputs.values(), result.interface]
    for time, i in zip(times, states, strict=True):
        along = i.weight * upward(case, i)
        distance = _distance(case, time)
        worn = along @ i.wear_1.clip(0.0, bush.thickness) / bush.coating
        worn += along @ (i.wear_1 - bush.thickness).clip(0.0) / bush.substrate
        quantity = f"volumes over coefficients, along the load, after {distance:.4g} m{note} [N m]"
        yield compare(quantity, worn, bush.force * distance, 1e-6, BALANCE)
        quantity = f"largest depth after {distance:.4g} m{note} [m]"
        yield compare(quantity, i.wear_1.max(), bush.depth(distance), 2e-2, RIGID)
        quantity = f"force along the load after {distance:.4g} m{note} [N]"
        yield compare(quantity, along @ i.pressure, bush.force, 1e-6, FORCES)
    found = result.summary["worn_through_distance_1_m"]
    yield compare(f"sliding distance of wear-through{note} [m]", found, bush.begin, 1e-2, RIGID)
    volumes = zip(
        ("coating", "substrate"),
        result.summary["layer_volumes_1_m3"],
        bush.volumes(_distance(case, times[-1])),
        strict=True,
    )
    for name, volume, known in volumes:
        yield compare(f"volume of the {name}{note} [m³]", volume, known, 1e-2, RIGID)


def _distance(case: Case, time: float) -> float:
    """Sliding distance [m]."""
    return abs(case.motion.angular_velocity) * case.geometry.shaft_radius * time
