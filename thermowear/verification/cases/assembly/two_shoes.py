"""Leading and trailing shoe in one drum: torques of the long-shoe law, steady and after running-in.

The example of internal expanding shoes in Shigley's Mechanical Engineering Design: both shoes are
pushed apart by one force, and brake with 365.8 N m and 161.9 N m, whichever of them is the leading
one. Rigid shoes have the same steady pressures as elastic ones.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ....case.assembly.schema import AssemblyCase
from ....laws.motions import rotation
from ....reference.rigid_faces import DrumBrakeShoe
from ....results import Result
from ...check import Check, compare, computed, starter
from ...closed_forms.guided import SHIGLEY
from ..steady.finite_elements import EDGE, PRINCIPLE

STARTER = "two-shoe-drum"
TORQUE = 527.8
"""Torque of both shoes in the example, by its closed forms with all digits kept [N m]."""
_RUNNING_IN = "analysis={type='transient', until='steady', steady_tolerance=1e-3, tolerance=1e-3}"
_SENSES = {"clockwise": ("right_shoe", "-0.2"), "anticlockwise": ("left_shoe", "0.2")}
"""Leading shoe and angular velocity [rad/s] by the sense of rotation of the drum."""


def two_shoes() -> Iterator[Check]:
    """Torques of both shoes, and shapes, with both senses of rotation, cold and hot."""
    for (sense, (leading, speed)), without in (
        (item, without) for item in _SENSES.items() for without in ((), ("heat",))
    ):
        turning = f"motions.drum.angular_velocity={speed} rad/s"
        case = starter(STARTER, turning, without=without)
        note = f"drum {sense}, {'cold' if without else 'hot'}"
        steady = computed(case)
        worn = computed(starter(STARTER, turning, _RUNNING_IN, without=without))
        yield from _torques(case, steady, leading, f"{note}, steady", 1e-6)
        yield from _torques(case, worn, leading, f"{note}, after running-in", 1e-3)
        for shoe in steady.contacts:
            quantity = (
                f"worn shape of the {shoe} after running-in minus the steady one, largest, {note}, "
                "over its range [m]"
            )
            off, size = _shape_error(case, shoe, steady, worn)
            yield compare(quantity, off, 0.0, 5e-3, PRINCIPLE, size)


def long_shoe(case: AssemblyCase, shoe: str, leads: bool) -> tuple[DrumBrakeShoe, float]:
    """Shoe of a case as one of the long-shoe law, and its largest pressure [Pa]."""
    geometry, holder = case.geometry, case.holders[shoe]
    pivot = geometry.shoes[shoe].pivot  # type: ignore[attr-defined]
    friction = case.contacts[shoe].nominal_friction
    ends = [abs(math.remainder(a - math.atan2(*pivot), 2 * math.pi)) for a in _arc(case, shoe)]
    law = DrumBrakeShoe(
        radius=geometry.drum_radius,  # type: ignore[attr-defined]
        pivot_distance=math.hypot(*pivot),
        width=geometry.thickness,  # type: ignore[attr-defined]
        start=min(ends),
        end=max(ends),
        friction=-friction if leads else friction,
    )
    assert holder.force is not None
    assert holder.point is not None
    moment = holder.force * (holder.point[1] - pivot[1])  # of a force along x
    return law, moment / law.actuating_moment(1.0)


def _arc(case: AssemblyCase, shoe: str) -> tuple[float, float]:
    return case.geometry.shoes[shoe].arc  # type: ignore[attr-defined]


def _torques(
    case: AssemblyCase, result: Result, leading: str, note: str, allowed: float
) -> Iterator[Check]:
    total = 0.0
    for shoe in result.contacts:
        found = result.summary["contacts"][shoe]
        role = "leading" if shoe == leading else "trailing"
        law, largest = long_shoe(case, shoe, shoe == leading)
        torque = found["friction_torque_Nm"]
        quantity = f"torque of the {role} shoe, {note} [N m]"
        yield compare(quantity, torque, law.torque(largest), allowed, SHIGLEY)
        quantity = f"largest pressure of the {role} shoe, {note} [Pa]"
        yield compare(quantity, found["max_pressure_Pa"], largest, 1e-3, SHIGLEY)
        total += torque
    yield compare(f"torque of both shoes, {note} [N m]", total, TORQUE, 1e-3, SHIGLEY)


def _shape_error(
    case: AssemblyCase, shoe: str, steady: Result, worn: Result
) -> tuple[float, float]:
    """Largest difference between the shapes of a shoe, and the range of the steady one [m].

    Shapes are determined up to a rotation about the pivot. The ends of the face are excluded.
    """
    own, profile = steady.contacts[shoe], steady.profile
    points = np.column_stack([profile.x, profile.y, profile.z])[own]
    normals = np.column_stack([profile.normal_x, profile.normal_y, profile.normal_z])[own]
    pivot = case.geometry.shoes[shoe].pivot  # type: ignore[attr-defined]
    turned = (rotation((0.0, 0.0, 1.0), np.array(pivot)).at(points) * normals).sum(axis=1)
    s = steady.interface.s[own]
    inner = (s > s.min() + EDGE) & (s < s.max() - EDGE)
    modes = np.column_stack([np.ones(len(turned)), turned])[inner]

    def shape(result: Result) -> np.ndarray:
        heights = result.interface.shape[own][inner]
        return heights - modes @ np.linalg.lstsq(modes, heights, rcond=None)[0]

    exact = shape(steady)
    return float(np.abs(shape(worn) - exact).max()), float(np.ptp(exact))
