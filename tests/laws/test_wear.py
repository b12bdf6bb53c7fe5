"""Wear laws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thermowear.laws import LocalState, PowerWear


def test_friction_coefficient_enters_inside_the_power():
    """requirement: β multiplies (μ p)^b v^a, so κ = β μ^b."""
    law = PowerWear.per_friction_stress(2e-13, 0.25, 2.0, 1.5)
    rate = law.value(LocalState(np.array([3e6]), np.array([0.2])))
    assert rate[0] == pytest.approx(2e-13 * (0.25 * 3e6) ** 2 * 0.2**1.5, rel=1e-14)


def test_archard_volume():
    """requirement: V = k F s for a = b = 1, whatever the pressure distribution."""
    weights = np.array([1e-4, 3e-4, 2e-4])
    pressure = np.array([5e6, 1e6, 8e6])
    law = PowerWear(1e-14)
    volume_rate = weights @ law.value(LocalState(pressure, np.full(3, 0.3)))
    assert volume_rate == pytest.approx(1e-14 * (weights @ pressure) * 0.3, rel=1e-14, abs=0.0)


@given(b=st.floats(0.3, 3.0), a=st.floats(0.0, 3.0), p=st.floats(1e3, 1e9), v=st.floats(1e-4, 1e2))
def test_slope_is_the_derivative_of_the_rate(b, a, p, v):
    """requirement: Newton's method sees the true slope."""
    law = PowerWear(1e-13, b, a)
    h = 1e-6 * p
    state = LocalState(np.array([p]), np.array([v]))
    above, below = (law.value(state._replace(p=state.p + s))[0] for s in (h, -h))
    slope = law.slope(state)[0]
    assert (above - below) / (2 * h) == pytest.approx(slope, rel=1e-7)


def test_tension_does_not_wear():
    """requirement: wear never goes back; the slope stays finite at p = 0 for b < 1."""
    law = PowerWear(1e-13, 0.5)
    state = LocalState(np.array([-1e6, 0.0, 1e6]), np.ones(3))
    assert np.all(law.value(state)[:2] == 0.0)
    assert np.all(np.isfinite(law.slope(state)))
