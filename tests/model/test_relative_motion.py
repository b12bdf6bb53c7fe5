"""Sliding of two bodies, of which one turns about an axis in space."""

import numpy as np
import pytest

import thermowear as tw
from thermowear.bulk.kinematics import Spatial
from thermowear.errors import CaseError
from thermowear.model.conditions import Motion
from thermowear.model.relative_motion import relative_motion

POINT = (0.01, 0.0, 0.02)
POINTS = np.random.default_rng(3).normal(size=(20, 3))


def turning(ω=3.0, axis=(0.0, 2.0, 0.0)):
    return tw.Rotation(ω, POINT, axis=axis).in_model()


def velocity(motion):
    return Spatial().sliding(POINTS, motion, motion.center)


def test_velocity_about_an_axis():
    """requirement: ω × (x - x_0); about a vertical axis that of a disk below, the other way."""
    np.testing.assert_allclose(
        velocity(turning()), np.cross([0.0, 3.0, 0.0], POINTS - POINT), rtol=1e-13
    )
    vertical = relative_motion(turning(-3.0, (0.0, 0.0, 1.0)), None, axisymmetric=False)
    disk = relative_motion(None, tw.Rotation(3.0, POINT[:2]).in_model(), axisymmetric=False)
    np.testing.assert_allclose(velocity(vertical), velocity(disk), atol=1e-13)


def test_either_body_turns():
    """requirement: a socket that turns is the ball that turns the other way."""
    ball = relative_motion(turning(3.0), None, axisymmetric=False)
    socket = relative_motion(None, turning(-3.0), axisymmetric=False)
    assert ball == socket
    assert not ball.passes


def test_a_body_that_turns_slides_on_one_at_rest():
    """requirement: another moving body is refused."""
    for other in (Motion(velocity=1.0), turning(1.0)):
        for pair in ((turning(), other), (other, turning())):
            with pytest.raises(CaseError, match="must slide on one at rest"):
                relative_motion(*pair, axisymmetric=False)


@pytest.mark.parametrize(
    ("center", "axis", "message"),
    [
        ((0.0, 0.0), (0.0, 1.0, 0.0), r"Rotation.center: has 2 coordinates; needs 3"),
        ((0.0, 0.0, 0.0), None, r"Rotation.center: has 3 coordinates; needs 2"),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), r"Rotation.axis: the vector has no direction"),
    ],
)
def test_axes_that_cannot_be_are_refused(center, axis, message):
    """requirement: one line that names the argument."""
    with pytest.raises(CaseError, match=message):
        tw.Rotation(1.0, center, axis=axis).in_model()


def test_the_first_body_may_be_the_one_that_moves():
    """requirement: it slides as a second body does that moves the opposite way, and it passes."""
    for moving in (tw.Rotation(3.0, POINT[:2]), tw.Translation(3.0)):
        opposite = moving.in_model().faster(-1.0)
        first = relative_motion(moving.in_model(), None, axisymmetric=False)
        second = relative_motion(None, opposite, axisymmetric=False)
        np.testing.assert_array_equal(velocity(first), velocity(second))
        assert (first.moving_side, second.moving_side) == (0, 1)
        assert first.passes
    spinning = tw.Rotation(3.0, POINT[:2]).in_model()
    with pytest.raises(CaseError, match="cannot both rotate"):
        relative_motion(spinning, spinning, axisymmetric=False)
