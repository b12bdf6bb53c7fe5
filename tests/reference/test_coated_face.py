"""Closed forms of coated faces, against integrals of the worn shape."""

from math import pi

import numpy as np
import pytest
from scipy.integrate import quad

from thermowear.reference.coatings import CoatedBall, flat_face_depth

BALL = CoatedBall(radius=12e-3, thickness=3e-6, coating=2e-14, substrate=3e-13, force=20.0)


def test_flat_face():
    """requirement: h/r for each layer, then the rate of the substrate."""
    thickness, rates = (4.0, 6.0), (1.0, 3.0, 2.0)
    found = [flat_face_depth(t, thickness, rates) for t in (0.0, 1.0, 4.0, 5.0, 6.0, 16.0)]
    assert found == pytest.approx([0.0, 1.0, 4.0, 7.0, 10.0, 30.0])


@pytest.mark.parametrize("multiple", [0.3, 1.0, 1.001, 4.0, 50.0])
def test_ball(multiple):
    """requirement: volumes of the worn shape, and V_c/k_c + V_s/k_s = F s."""
    distance = multiple * BALL.begin
    a, b = BALL.worn_radius(distance), BALL.bare_radius(distance)

    def depth(r):
        return (a**2 - r**2) / (2 * BALL.radius)

    coating, _ = quad(lambda r: 2 * pi * r * min(depth(r), BALL.thickness), 0, a, points=[b])
    substrate, _ = quad(lambda r: 2 * pi * r * max(depth(r) - BALL.thickness, 0), 0, a, points=[b])
    found = BALL.volumes(distance)
    assert found == pytest.approx((coating, substrate), rel=1e-9, abs=1e-24)
    done = found[0] / BALL.coating + found[1] / BALL.substrate
    assert done == pytest.approx(BALL.force * distance, rel=1e-12)
    assert (b > 0) == (multiple > 1)


def test_ball_like_its_coating():
    """requirement: with one coefficient, the cap of Archard's law."""
    ball = CoatedBall(12e-3, 3e-6, 2e-14, 2e-14, 20.0)
    distances = np.array([0.5, 3.0]) * ball.begin
    found = [sum(ball.volumes(s)) for s in distances]
    assert found == pytest.approx(list(2e-14 * 20.0 * distances), rel=1e-12, abs=0.0)
