"""Shaft in a coated bush: worn volumes, wear-through, and equilibrium with friction."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from thermowear.reference.coatings import CoatedBush

from ..case.starter import solved
from ..slow import marked_slow

BUSH = "shaft-in-bush-coated"
R, SPEED, FORCE = 10e-3, 0.2, 500.0
COATING, SUBSTRATE, THICKNESS = 1e-14, 1e-13, 4e-6
COARSE = {
    "mesh.elements": 40,
    "geometry.zone": "5 mm",
    "wear.bush.coefficient": f"{SUBSTRATE} 1/Pa",
    "wear.bush.layers": {"thickness": ["4 um"], "coefficient": [f"{COATING} 1/Pa"]},
    "analysis": {"type": "transient", "end_time": "700 s", "tolerance": 3e-3},
}


@functools.cache
def worn(friction: float, sense: int, *free: str):
    changes = {
        "contact.friction": friction,
        "motion.angular_velocity": f"{20 * sense} rad/s",
        "holder": {"free": list(free or ("z", "x"))},
    }
    return solved(BUSH, COARSE | changes)


def angles(i) -> np.ndarray:
    """Angles from the bottom about the shaft's centre, towards +x."""
    return np.arctan2(i.x, R - i.y)


def load_and_side(i, drag: float) -> tuple[np.ndarray, np.ndarray]:
    """Parts of the traction of a unit pressure on the shaft: upwards, and along x.

    The shaft, turning anticlockwise, slides at its bottom along +x; friction acts against it.
    """
    θ = angles(i)
    normal, against = (-np.sin(θ), np.cos(θ)), (-np.cos(θ), -np.sin(θ))
    up, side = normal[1] + drag * against[1], normal[0] + drag * against[0]
    return i.weight * up, i.weight * side


@pytest.mark.parametrize(
    ("friction", "sense"), marked_slow([(0.0, 1), (0.1, 1), (0.1, -1)], (0.0, 1), (0.1, -1))
)
def test_volumes_over_coefficients_are_force_times_distance(friction, sense):
    """requirement: V_c/k_c + V_s/k_s = F s, of the parts along the load; equilibrium across it."""
    result = worn(friction, sense)
    i = result.interface
    up, side = load_and_side(i, friction * sense)
    coating = THICKNESS - i.coating_left_1
    lost = coating / COATING + (i.wear_1 - coating) / SUBSTRATE
    assert i.wear_1.max() > 1.5 * THICKNESS
    assert up @ lost == pytest.approx(FORCE * SPEED * 700.0, rel=1e-6)
    assert up @ i.pressure == pytest.approx(FORCE, rel=1e-6)
    assert side @ i.pressure == pytest.approx(0.0, abs=1e-5 * FORCE)
    middle = np.average(angles(i), weights=i.weight * i.pressure)
    assert middle == pytest.approx(-sense * np.arctan(friction), abs=2e-3)
    volumes = result.summary["layer_volumes_1_m3"]
    known = [i.weight @ coating, i.weight @ (i.wear_1 - coating)]
    assert volumes == pytest.approx(known, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("friction", marked_slow([0.0, 0.1], 0.0))
def test_the_coating_is_worn_through_when_the_closed_form_says(friction):
    """requirement: rigid bodies; elastic ones deform by a tenth of the coating's thickness."""
    bush = CoatedBush(R, 20e-3, 60e-6, THICKNESS, COATING, SUBSTRATE, FORCE, friction)
    result = worn(friction, 1)
    found = result.summary["worn_through_distance_1_m"]
    assert found == pytest.approx(bush.begin, rel=2e-2)
    time = result.summary["worn_through_time_1_s"]
    assert found == pytest.approx(SPEED * time, rel=1e-6)
    slid = SPEED * 700.0
    assert result.interface.wear_1.max() == pytest.approx(bush.depth(slid), rel=2e-2, abs=0.0)
    known = bush.volumes(slid)
    assert result.summary["layer_volumes_1_m3"] == pytest.approx(known, rel=3e-2, abs=0.0)


def test_the_torque_is_that_of_the_holder():
    """requirement: mu R ∫ p dA; the bush takes it up, to the clearance over the radius."""
    result = worn(0.1, 1)
    i = result.interface
    torque = result.summary["friction_torque_Nm"]
    assert torque == pytest.approx(0.1 * R * (i.weight @ i.pressure), rel=1e-6)
    assert -result.summary["guide_moment_Nm"] == pytest.approx(torque, rel=6e-3)


def test_a_guided_bush_takes_up_the_friction():
    """requirement: a bush that cannot move along x is pushed by mu times the force."""
    result = worn(0.1, 1, "z")
    i = result.interface
    up, side = load_and_side(i, 0.1)
    assert up @ i.pressure == pytest.approx(FORCE, rel=1e-6)
    found = result.summary["guide_force_N"]
    assert abs(found) == pytest.approx(abs(side @ i.pressure), rel=1e-6)
    assert abs(found) == pytest.approx(0.1 * FORCE, rel=1e-2)
