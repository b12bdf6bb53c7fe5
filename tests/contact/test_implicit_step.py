"""Newton's method for implicit wear, on a contact of springs that is solved by hand."""

from dataclasses import dataclass

import numpy as np
import pytest

from thermowear.contact.wear.implicit_step import WearRates, newton_with_wear
from thermowear.errors import ComputationError
from thermowear.laws.distribution import Distribution
from thermowear.laws.wear import PowerWear

STIFFNESS = np.array([1.0, 2.0])


@dataclass(frozen=True)
class Pressed:
    pressure: np.ndarray


class Power:
    """Depth ``p^b``."""

    def __init__(self, b):
        self.b = b

    def value(self, pressure, last):
        return np.maximum(pressure, 0.0) ** self.b

    def slope(self, pressure, last):
        return np.diag(self.b * np.maximum(pressure, 0.0) ** (self.b - 1))


class Severe:
    """Depth that rises steeply where mild wear turns into severe wear."""

    def value(self, pressure, last):
        return 3 * (1 + np.tanh(5 * (pressure - 1)))

    def slope(self, pressure, last):
        return np.diag(15 / np.cosh(5 * (pressure - 1)) ** 2)


def solver(closing, count):
    """Springs closed by a distance; the linear wear ``start + slope p`` opens them."""

    def solve(start, slope, last):
        count.append(1)
        return Pressed(np.linalg.solve(np.diag(1 / STIFFNESS) + slope, closing - start))

    return solve


@pytest.mark.parametrize(("b", "most"), [(1.0, 1), (2.0, 8), (1.3, 8)])
def test_the_pressure_at_the_end_wears(b, most):
    """requirement: p/c + p^b = closing at each point, in one solution if wear is linear."""
    count, closing = [], np.array([3.0, 0.4])
    p = newton_with_wear(solver(closing, count), Power(b), Pressed(np.ones(2))).pressure
    np.testing.assert_allclose(p / STIFFNESS + p**b, closing, rtol=1e-10)
    assert len(count) <= most


def test_steep_laws_are_damped():
    """requirement: converges where the undamped iteration leaves the steep part for good."""
    count, wear, closing = [], Severe(), np.array([5.0, 5.0])
    p = newton_with_wear(solver(closing, count), wear, Pressed(np.full(2, 0.1))).pressure
    np.testing.assert_allclose(p / STIFFNESS + wear.value(p, None), closing, rtol=1e-9)
    assert len(count) < 20


def test_failure_is_reported():
    """requirement: the message of the caller."""

    class Jumping(Power):
        def value(self, pressure, last):
            return np.where(pressure > 1.0, 5.0, 0.0)

        def slope(self, pressure, last):
            return np.zeros((2, 2))

    with pytest.raises(ComputationError, match="take smaller increments"):
        newton_with_wear(
            solver(np.full(2, 3.0), []),
            Jumping(1.0),
            Pressed(np.ones(2)),
            failure="take smaller increments",
        )


def test_rates_of_two_bodies():
    """requirement: step Σ share factor κ p^b v^a, each with the data of its body, and its slope."""
    pressure, factors = np.array([2.0, 3.0]), np.array([[1.0, 2.0], [3.0, 5.0]])
    states = [tuple(np.full(2, value) for value in (speed, 0.0, 0.0, 0.0)) for speed in (2.0, 3.0)]
    laws = [PowerWear(0.1, 2.0, 1.0), PowerWear(0.2, 1.0, 2.0)]
    wear = WearRates(laws, [Distribution(0.5), Distribution(0.25)], factors, states, step=7.0)
    first = 0.5 * factors[0] * 0.1 * pressure**2 * 2.0
    second = 0.25 * factors[1] * 0.2 * pressure * 9.0
    np.testing.assert_allclose(wear(pressure), [first, second], rtol=1e-14)
    np.testing.assert_allclose(wear.value(pressure), 7 * (first + second), rtol=1e-14)
    slope = 7 * (2 * first / pressure + second / pressure)
    np.testing.assert_allclose(wear.slope(pressure).point, slope, rtol=1e-14)
