"""A ball that turns in a socket about an axis in space."""

import math

import numpy as np
import pytest

from thermowear.errors import CaseError
from thermowear.verification.check import computed, starter

RADIUS, ANGLE, FORCE, SPEED, RATE = 14e-3, math.radians(75.0), 500.0, 1.6, 1e-15
COARSE = (
    "mesh.elements=10",
    "contact.friction=0",
    'geometry.clearance="1 um"',
    'analysis={type="steady"}',
)
WHOLE = (*COARSE, "geometry.half=false", 'load.force="1000 N"', "mesh.elements=6")


def case(*overrides):
    wear = 'wear.socket={coefficient="1e-9 1/MPa", per="pressure"}'
    return starter(
        "ball-in-socket", wear, 'load={force="500 N"}', *overrides, without=("wear", "analysis")
    )


def about(direction, *more):
    point = '["0 mm", "0 mm", "14 mm"]'
    return (f"motion.axis={{point={point}, direction={direction}}}", *more)


def test_steady_pressure_of_a_swinging_ball():
    """requirement: wear sinks the socket uniformly: p = λ n_z / (k ω d), d from the axis.

    With the force N of the half, λ = k ω N / ∫ n_z² / d dA.
    """
    i = computed(case(*COARSE)).interface
    n_z = 1 - i.z / RADIUS
    away = np.hypot(i.x, i.z - RADIUS)
    expected = n_z / away
    expected *= FORCE / (i.weight @ (expected * n_z))
    sure = away > 0.3 * RADIUS
    np.testing.assert_allclose(i.pressure[sure], expected[sure], rtol=0.02)
    # independent of the mesh: ∫ cos²θ / sqrt(1 - sin²θ sin²φ) sin θ dθ dφ
    θ, φ = (np.linspace(0, end, 4001) for end in (ANGLE, math.pi))
    θ, φ = (0.5 * (each[1:] + each[:-1]) for each in (θ, φ))
    s, c = np.sin(θ)[:, None], np.cos(θ)[:, None]
    sums = (c**2 * s / np.sqrt(1 - (s * np.sin(φ)) ** 2)).sum() * ANGLE / 4000 * math.pi / 4000
    lowest = i.pressure[np.argmin(np.hypot(i.x, i.y))]
    assert lowest == pytest.approx(FORCE / (sums * RADIUS**2), rel=0.02)


def test_friction_torque_and_heat_of_a_rotation_about_an_axis():
    """requirement: torque ∫ μ p d dA about the axis; its power is the friction heat."""
    result = computed(case(*COARSE, "contact.friction=0.06"))
    i, summary = result.interface, result.summary
    arms = np.hypot(i.x, i.z - RADIUS)
    torque = 0.06 * (i.weight * i.pressure) @ arms
    assert summary["friction_torque_Nm"] == pytest.approx(torque, rel=1e-3)
    assert summary["friction_power_W"] == pytest.approx(SPEED * torque, rel=1e-3)


def test_sense_of_friction():
    """requirement: the ball turns from z to x at its top, its lowest point along -x.

    Friction pulls the socket that way: the guide of the ball reacts along -x.
    """
    forward, back = (
        computed(case(*COARSE, "contact.friction=0.06", f'motion.angular_velocity="{ω} rad/s"'))
        for ω in (SPEED, -SPEED)
    )
    forces = [found.summary["guide_force_N"] for found in (forward, back)]
    assert forces[0] < 0
    assert forces[0] == pytest.approx(-forces[1], rel=1e-3)


def test_axes_of_any_direction_and_length():
    """requirement: rotations about x and y, and by vectors, give the same turned pressures."""
    along_x = computed(case(*WHOLE, *about('"x"')))
    along_y = computed(case(*WHOLE, *about("[0.0, 2.5, 0.0]")))
    slanted = computed(case(*WHOLE, *about("[-1.0, 1.0, 0.0]")))
    highest = [found.summary["max_pressure_Pa"] for found in (along_x, along_y, slanted)]
    np.testing.assert_allclose(highest, highest[0], rtol=0.1)
    for found, turned in ((along_x, 0.0), (along_y, 90.0), (slanted, 135.0)):
        i, φ = found.interface, math.radians(turned)
        along = i.x * math.cos(φ) + i.y * math.sin(φ)
        expected = (1 - i.z / RADIUS) / np.sqrt(RADIUS**2 - along**2)
        expected *= 1000.0 / (i.weight @ (expected * (1 - i.z / RADIUS)))
        error = i.weight @ np.abs(i.pressure - expected) / (i.weight @ expected)
        assert error < 0.02


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (about('"x"'), "motion.axis.direction: must be normal to the plane y = const"),
        (about("[0, 0, 0]"), "motion.axis.direction: .*no direction|motion.axis"),
        (about('"y"', 'motion.velocity="1 m/s"'), "motion.velocity: not supported"),
    ],
)
def test_axes_that_cannot_be_are_refused(overrides, message):
    """requirement: one line with the key."""
    with pytest.raises(CaseError, match=message):
        case(*COARSE, *overrides)


def test_an_axis_needs_a_model_in_space():
    """requirement: sections know only rotations about their own axis or centre."""
    with pytest.raises(CaseError, match=r"motion\.axis: requires a 3d model"):
        starter("annular-punch", *about('"y"'))
