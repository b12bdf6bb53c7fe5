"""Friction force, torque and power by the pressure at the points of an interface."""

from types import SimpleNamespace

import numpy as np
import pytest

from thermowear.laws.motions import axis_of
from thermowear.model.conditions import Motion
from thermowear.simulation.results.friction import friction_of

RANDOM = np.random.default_rng(8)
COUNT, OTHERS = 7, 3
PLANE = RANDOM.random((COUNT, 2))
SPACE = RANDOM.random((COUNT, 3))
CENTER = (0.4, -0.7)
# through (1, 2, 5) along y: distances in the plane of x and z
AXIS = axis_of((1.0, 2.0, 5.0), (0.0, 3.0, 0.0))
CASES = {
    "ring": ("axisymmetric", Motion(angular_velocity=2.0), PLANE, PLANE[:, 0]),
    "along a ring": ("axisymmetric", Motion(velocity=2.0), PLANE, None),
    "disk": (
        "plane-strain",
        Motion(angular_velocity=2.0, center=CENTER),
        PLANE,
        np.hypot(PLANE[:, 0] - 0.4, PLANE[:, 1] + 0.7),
    ),
    "axis": (
        "3d",
        Motion(angular_velocity=2.0, axis=AXIS),
        SPACE,
        np.hypot(SPACE[:, 0] - 1.0, SPACE[:, 2] - 5.0),
    ),
    "disk in space": (
        "3d",
        Motion(angular_velocity=2.0, center=CENTER),
        SPACE,
        np.hypot(SPACE[:, 0] - 0.4, SPACE[:, 1] + 0.7),
    ),
    "straight": ("3d", Motion(velocity=2.0), SPACE, None),
    "at rest": ("3d", Motion(), SPACE, None),
}


@pytest.mark.parametrize("name", CASES)
def test_force_torque_and_power(name):
    """requirement: sums of w mu p, of that times the distance from the axis, and of w mu p v."""
    kinematics, motion, points, arms = CASES[name]
    weights, pressure, friction, speed = RANDOM.random((4, OTHERS + COUNT))
    own = slice(OTHERS, None)
    pairing = SimpleNamespace(points=points, weights=weights[own])
    system = SimpleNamespace(
        model=SimpleNamespace(
            kinematics=kinematics, interfaces=(None, SimpleNamespace(motion=motion))
        ),
        contacts=SimpleNamespace(ranges=(slice(OTHERS), own), each=(None, pairing)),
    )
    heating = friction * speed * (not motion.at_rest)
    conditions = SimpleNamespace(friction=friction, heating=heating)
    found = friction_of(system, 1, conditions, pressure)
    stress = (weights * friction * pressure)[own] * (not motion.at_rest)
    assert found.force == pytest.approx(stress.sum(), abs=1e-14)
    assert found.power == pytest.approx((stress * speed[own]).sum(), abs=1e-14)
    assert found.torque == (None if arms is None else pytest.approx((stress * arms).sum()))
