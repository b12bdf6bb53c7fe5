"""The generic Newton method."""

import numpy as np
import pytest

from thermowear.laws import PowerWear
from thermowear.laws.principle.interior_point import PowerSum, solve

from .random_problems import curved_face


def power_sum(laws, speed):
    return PowerSum(
        np.array([law.factor(speed) for law in laws]),
        np.array([law.pressure_exponent for law in laws]),
    )


def test_power_sum():
    """requirement: value of ``Σ g p^e`` and its derivative, in any units."""
    law = PowerSum(np.array([[2.0, 3.0], [0.5, 1.0]]), np.array([0.5, 3.0]))
    p, h = np.array([4.0, 2.0]), 1e-6
    value, slope = law.at(p)
    np.testing.assert_allclose(value, [2 * 2 + 0.5 * 64, 3 * 2**0.5 + 8])
    np.testing.assert_allclose(slope, (law.at(p + h)[0] - law.at(p - h)[0]) / (2 * h), rtol=1e-8)
    units = np.array([10.0, 0.1])
    np.testing.assert_allclose(law.scaled(units, 7.0).at(p / units)[0], value / 7)


def test_the_start_does_not_matter():
    """requirement: one solution; another unit and other weights of the rates start elsewhere."""
    rng = np.random.default_rng(2)
    for _ in range(30):
        patch, load, laws = curved_face(rng, friction=0.3, eccentric=4.0)
        R, T, local = patch.normal_modes, patch.force_modes, power_sum(laws, patch.speed)
        found = solve(patch.weights, R, T, load, local)
        # the same load with the rates of all points in another unit: another first multiplier
        other = PowerSum(local.factors * 1e7, local.exponents)
        again = solve(patch.weights, R, T, load, other)
        np.testing.assert_allclose(again.pressure, found.pressure, atol=1e-9 * found.pressure.max())
        np.testing.assert_allclose(again.velocity / 1e7, found.velocity, rtol=1e-8, atol=1e-30)


def test_homogeneous():
    """requirement: with one exponent b, twice the load is twice the pressure and 2^b the rates."""
    rng = np.random.default_rng(3)
    patch, load, _ = curved_face(rng, friction=0.3, eccentric=6.0, motions=3)
    for b in (0.3, 1.0, 4.0):
        local = power_sum([PowerWear(1e-13 * 1e6 ** (1 - b), b)], patch.speed)
        once, twice = (
            solve(patch.weights, patch.normal_modes, patch.force_modes, factor * load, local)
            for factor in (1.0, 2.0)
        )
        np.testing.assert_allclose(
            twice.pressure, 2 * once.pressure, atol=1e-9 * once.pressure.max()
        )
        np.testing.assert_allclose(twice.velocity, 2**b * once.velocity, rtol=1e-7)


@pytest.mark.parametrize("exponent", [0.2, 8.0, 25.0])
def test_exponents_of_other_functionals(exponent):
    """requirement: the exponents that a large or small q leads to."""
    rng = np.random.default_rng(6)
    for _ in range(20):
        patch, load, _ = curved_face(rng, friction=0.2, eccentric=1.5)
        T, load = patch.force_modes, load / 1e7
        local = PowerSum(rng.uniform(0.5, 2.0, (1, len(patch.weights))), np.array([exponent]))
        found = solve(patch.weights, T, T, load, local)
        p = found.pressure
        scale = np.abs(T * patch.weights[:, None]).T @ p
        np.testing.assert_allclose(T.T @ (patch.weights * p), load, atol=1e-11 * scale.max())
        drive = np.maximum(T @ found.velocity, 0.0)
        np.testing.assert_allclose(
            np.where(p > 0, local.factors[0] * p**exponent, 0.0), drive, atol=1e-10 * drive.max()
        )


def test_no_solution_is_none_and_quiet(recwarn):
    """requirement: a load that no pressure carries ends in None, without noise."""
    x = np.linspace(-1, 1, 21)
    modes = np.column_stack([np.ones_like(x), x])
    local = PowerSum(np.ones((1, 21)), np.ones(1))
    for load in ([1.0, 1.2], [-1.0, 0.0], [0.0, 1.0]):
        assert solve(np.ones(21), modes, modes, np.array(load), local) is None
    assert not recwarn.list


def test_far_pivots():
    """requirement: turns about an axis a million lengths away, hardly a shift apart."""
    rng = np.random.default_rng(9)
    x, weights = rng.uniform(-1, 1, 60), rng.uniform(0.5, 1, 60)
    pressure = 1e6 * np.maximum(0.2 + x, 0.0) ** 2
    local = PowerSum(np.full((1, 60), 1e-16), np.array([0.5]))
    near, far = (
        solve(weights, modes, modes, modes.T @ (weights * pressure), local)
        for modes in (np.column_stack([np.ones(60), away + x]) for away in (0.0, 1e6))
    )
    np.testing.assert_allclose(far.pressure, near.pressure, atol=1e-7 * near.pressure.max())
