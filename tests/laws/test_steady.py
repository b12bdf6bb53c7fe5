"""The principle of minimum wear dissipation power."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermowear import ComputationError
from thermowear.laws import WearLaw, steady_pressure
from thermowear.reference import annular_punch

INNER, OUTER = 0.02, 0.12


def ring(n=40):
    """Radii and areas of Gauss points on the ring."""
    x, w = np.polynomial.legendre.leggauss(n)
    r = (INNER + OUTER) / 2 + (OUTER - INNER) / 2 * x
    return r, 2 * np.pi * r * w * (OUTER - INNER) / 2


def solve_ring(laws, force=4.39823e6, speed=10.0):
    r, weights = ring()
    down = np.ones((len(r), 1))
    return r, weights, steady_pressure(weights, down, down, np.array([force]), laws, speed * r)


@pytest.mark.parametrize("b", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("a", [1.0, 0.5, 2.0])
def test_annular_punch(a, b):
    """requirement: special case 8, p = (F/I) r^(-a/b); uniform normal wear rate."""
    r, _, steady = solve_ring([WearLaw(5e-14 * 1e6 ** (1 - b), b, a)])
    exact = annular_punch.steady_pressure(r, 4.39823e6, INNER, OUTER, b, a)
    np.testing.assert_allclose(steady.pressure, exact, rtol=1e-11)
    np.testing.assert_allclose(steady.rates[0], steady.velocity[0], rtol=1e-12)


@pytest.mark.parametrize(
    ("b", "at_20", "at_120", "torque"),
    [
        (0.5, 976.694, 27.130, 2.4547e8),
        (1, 350, 58.3333, 3.07876e8),
        (2, 191.649, 78.240, 3.35939e8),
    ],
)
def test_published_numbers(b, at_20, at_120, torque):
    """requirement: the numbers of the ring under 100 MPa (pressures in MPa, torque/mu in N mm)."""
    force = 100e6 * np.pi * (OUTER**2 - INNER**2)
    p = annular_punch.steady_pressure(np.array([INNER, OUTER]), force, INNER, OUTER, b) / 1e6
    assert p == pytest.approx([at_20, at_120], rel=2e-5)
    r, weights, steady = solve_ring([WearLaw(5e-14 * 1e6 ** (1 - b), b)], force)
    assert weights @ (steady.pressure * r) * 1e3 == pytest.approx(torque, rel=2e-5)


def test_both_bodies_wear_with_different_exponents():
    """requirement: with b1 ≠ b2 the sum of both rates equals the rigid-body rate point by point."""
    laws = [WearLaw(5e-14, 1.0), WearLaw(2e-21, 2.0)]
    _, weights, steady = solve_ring(laws)
    np.testing.assert_allclose(sum(steady.rates), steady.velocity[0], rtol=1e-12)
    assert min(rate.max() for rate in steady.rates) > 0.05 * steady.velocity[0]
    assert weights @ steady.pressure == pytest.approx(4.39823e6, rel=1e-12)


def test_tilting_rectangular_punch():
    """requirement: special case 2 (60 x 80 mm, eccentric load): p^b linear along x."""
    expected = {
        0.5: (3.213694, 2.038987, 1.130360),
        1: (3.125, 2.083333, 1.041667),
        2: (2.980545, 2.170253, 0.732357),
    }
    x, wx = np.polynomial.legendre.leggauss(30)
    ξ, w = 30e-3 * x, 30e-3 * wx * 80e-3
    modes = np.column_stack([np.ones_like(ξ), -ξ / 30e-3])
    load = np.array([10e3, 10e3 * 5 / 30])
    for b, values in expected.items():
        steady = steady_pressure(
            w, modes, modes, load, [WearLaw(1e-10 * 1e6 ** (1 - b), b)], np.full(30, 5e-3)
        )
        rate = np.polynomial.Polynomial.fit(ξ, steady.pressure**b, 1)
        at = rate(np.array([-30e-3, 0.0, 30e-3])) ** (1 / b) / 1e6
        assert at == pytest.approx(values, rel=1e-6)


@pytest.mark.parametrize(
    ("b", "sense", "low", "high"),
    [(1, 1, 0.831025, 2.493075), (1, -1, 1.038062, 3.114187), (2, 1, 1.22949, 2.12954)],
)
def test_pivoted_block(b, sense, low, high):
    """requirement: special case 5: friction enters through equilibrium only (brake block)."""
    x, w = np.polynomial.legendre.leggauss(40)
    z = 0.1 + 0.05 * x
    arm = z + sense * 0.3 * 0.04
    steady = steady_pressure(
        0.05 * w * 0.01, z[:, None], arm[:, None], np.array([1000 * 0.2]),
        [WearLaw(1e-13 * 1e6 ** (1 - b), b)], np.ones(40),
    )  # fmt: skip
    scale = steady.pressure / z ** (1 / b)
    np.testing.assert_allclose(scale, scale[0], rtol=1e-12)
    ends = scale[0] * np.array([0.05, 0.15]) ** (1 / b) / 1e6
    assert ends == pytest.approx([low, high], rel=2e-6)


def test_lifts_off_where_the_rigid_rate_is_negative():
    """requirement: p = 0 where V·n < 0; a load outside the kernel lifts one side off."""
    x, w = np.polynomial.legendre.leggauss(200)
    modes = np.column_stack([np.ones_like(x), x])
    steady = steady_pressure(w, modes, modes, np.array([1.0, 0.6]), [WearLaw(1.0)], np.ones(200))
    zone = 3 * (1 - 0.6)
    assert np.all(steady.pressure[x < 1 - zone - 0.02] == 0)
    exact = np.maximum(0, 2 / zone**2 * (x - (1 - zone)))
    assert np.abs(steady.pressure - exact).max() < 0.01 * exact.max()


def dissipation(pressure, weights, law, speed):
    return weights @ (pressure * law.rate(pressure, speed))


@settings(max_examples=50, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1), b=st.sampled_from([0.5, 1.0, 2.0]), size=st.floats(1e-3, 0.5)
)
def test_no_admissible_change_lowers_the_dissipation(seed, b, size):
    """requirement: the solution is the minimum of D_w among pressures in equilibrium."""
    law = WearLaw(5e-14 * 1e6 ** (1 - b), b)
    r, weights, steady = solve_ring([law])
    change = np.random.default_rng(seed).normal(size=len(r)) * steady.pressure
    change -= steady.pressure * (weights @ change) / (weights @ steady.pressure)
    change *= size / np.abs(change / steady.pressure).max()
    perturbed = dissipation(steady.pressure + change, weights, law, 10 * r)
    assert steady.dissipation == pytest.approx(4.39823e6 * steady.velocity[0], rel=1e-12)
    assert perturbed > dissipation(steady.pressure, weights, law, 10 * r) * (1 - 1e-13)


def test_points_at_rest_have_no_steady_state():
    """requirement: what cannot wear is reported, not divided by zero."""
    r, weights = ring(5)
    down = np.ones((5, 1))
    with pytest.raises(ComputationError, match="do not slide"):
        steady_pressure(weights, down, down, np.ones(1), [WearLaw(1.0)], r * 0)
