"""Minima of the functionals under equilibrium."""

import itertools

import numpy as np
import pytest

from thermowear import ComputationError
from thermowear.laws import (
    NotCarried,
    PowerWear,
    admissible_changes,
    friction_dissipation,
    least_wear_dissipation,
    minimise,
    wear_dissipation,
    wear_volume_rate,
)

from .random_problems import curved_face

N = 30
X, W = np.polynomial.legendre.leggauss(N)
SPEED = 2.0 + X  # 1 … 3 over the face
DOWN = np.ones((N, 1))
LOAD = np.array([2e7])


def proportional(pressure, shape):
    np.testing.assert_allclose(
        pressure / shape, np.mean(pressure / shape), rtol=1e-9, err_msg="not proportional"
    )


@pytest.mark.parametrize(("a", "b"), [(1.0, 1.0), (0.5, 2.0), (2.0, 0.6)])
@pytest.mark.parametrize("q", [0.8, 1.0, 2.0, 4.0])
def test_the_family_of_translation(a, b, q):
    """requirement: the exponents of v in each minimum; only D_w, q = 1 has p^b v^a = const."""
    law = [PowerWear(1e-13 * 1e6 ** (1 - b), b, a)]
    found = {}
    for name, functional, power in (
        ("D_w", wear_dissipation(W, law, SPEED, q), -a * q / ((b + 1) * q - 1)),
        ("D_F", friction_dissipation(W, 0.3, SPEED, q), -q / (q - 1) if q != 1 else None),
        ("W", wear_volume_rate(W, law, SPEED, q), -a * q / (b * q - 1) if b * q != 1 else None),
    ):
        if functional.defined:
            minimum = minimise(functional, DOWN, LOAD)
            proportional(minimum.pressure, SPEED**power)
            assert W @ minimum.pressure == pytest.approx(LOAD[0], rel=1e-12)
            found[name] = minimum.pressure**b * SPEED**a
    assert "D_w" in found
    uniform = np.ptp(found["D_w"]) < 1e-9 * found["D_w"].max()
    assert uniform == (q == 1)


@pytest.mark.parametrize("q", [0.7, 2.0, pytest.param(5.0, marks=pytest.mark.slow)])
def test_pressure_of_two_bodies(q):
    """requirement: ``p = [TΛ c^-q / Σ Z_i^q C_i^((1-q)/q)]^(1/((b+1)q-1))``, with friction."""
    b, laws = 1.5, [PowerWear(1e-16, 1.5, 0.3), PowerWear(4e-16, 1.5, 2.0)]
    R = np.column_stack([np.ones(N), X])
    T = R + 0.2 * np.column_stack([X, 1 - X])
    load = T.T @ (W * (1.2e7 + 2e6 * X))
    least = least_wear_dissipation(W, R, T, load, laws, SPEED, q)
    pressed = least.pressure > 0
    opposed, approach = (modes[pressed] @ least.multipliers for modes in (T, R))
    c, p = opposed / approach, least.pressure[pressed]
    assert pressed.sum() > 15
    assert np.ptp(c) > 0.01
    Z = [law.factor(SPEED[pressed]) for law in laws]
    parts = [W[pressed] @ (c * z * p ** (b + 1)) ** q for z in Z]
    total = sum(z**q * part ** ((1 - q) / q) for z, part in zip(Z, parts, strict=True))
    proportional(p, (opposed * c**-q / total) ** (1 / ((b + 1) * q - 1)))


def test_both_ways_to_the_steady_state():
    """requirement: the minimum of D_w is the steady state that the kinematics gives.

    Two bodies with the same b, friction, up to three motions, faces that part.
    """
    rng = np.random.default_rng(21)
    compared = 0
    for _ in range(80):
        patch, load, laws = curved_face(rng, friction=0.3, eccentric=3.0)
        b = laws[0].pressure_exponent
        laws = [PowerWear(1e-13 * 1e6 ** (1 - b), b, law.velocity_exponent) for law in laws]
        steady = patch.steady(load, laws)
        there = steady.approach > 0
        factor = (patch.force_modes @ steady.velocity)[there] / steady.approach[there]
        if factor.min() < 0.05:  # friction would drive the wear: no minimum
            continue
        part = patch.part(there)
        given = wear_dissipation(part.weights, laws, part.speed, 1.0, factor)
        free = least_wear_dissipation(
            patch.weights, patch.normal_modes, patch.force_modes, load, laws, patch.speed
        )
        fixed = minimise(given, part.force_modes, load)
        scale = steady.pressure.max()
        np.testing.assert_allclose(free.pressure, steady.pressure, atol=1e-9 * scale)
        np.testing.assert_allclose(fixed.pressure, steady.pressure[there], atol=1e-9 * scale)
        np.testing.assert_allclose(
            free.multipliers / (b + 1), steady.velocity, atol=1e-9 * np.abs(steady.velocity).max()
        )
        assert free.value == pytest.approx(steady.dissipation, rel=1e-9)
        compared += 1
    assert compared > 60


@pytest.mark.parametrize(
    "q",
    [
        0.6,
        1.0,
        3.0,
        pytest.param(1.5, marks=pytest.mark.slow),
        pytest.param(10.0, marks=pytest.mark.slow),
    ],
)
def test_each_is_its_own_minimum(q):
    """requirement: random problems; no admissible pressure among 200 has less."""
    rng = np.random.default_rng(31)
    tried = 0
    for _ in range(12):
        patch, load, laws = curved_face(rng, friction=0.3, eccentric=1.0)
        T = patch.force_modes
        for functional in (
            wear_dissipation(patch.weights, laws, patch.speed, q),
            friction_dissipation(patch.weights, 0.3, patch.speed, q),
            wear_volume_rate(patch.weights, laws, patch.speed, q),
        ):
            if not functional.defined:
                continue
            found = minimise(functional, T, load)
            changes = admissible_changes(rng, 200, patch.weights, T, found.pressure)
            assert np.all(functional(found.pressure + changes) > found.value)
            tried += 1
    assert tried > 5


def test_multipliers_are_the_price_of_the_load():
    """requirement: Λ is the derivative of the least value by the load."""
    rng = np.random.default_rng(5)
    patch, load, _ = curved_face(rng, friction=0.2, eccentric=1.0, motions=3)
    law = [PowerWear(1e-13)]
    functional = wear_dissipation(patch.weights, law, patch.speed, 2.0)
    found = minimise(functional, patch.force_modes, load)
    for i in range(3):
        h = np.zeros(3)
        h[i] = 1e-4 * load[i]
        ahead, behind = (
            minimise(functional, patch.force_modes, load + s * h).value for s in (1, -1)
        )
        slope = (ahead - behind) / (2 * h[i])
        assert slope == pytest.approx(found.multipliers[i], rel=1e-5)


@pytest.mark.slow
def test_inclinations_are_those_of_the_minimum_or_it_is_refused():
    """requirement: χ agrees with the multipliers; where no direction does, that is said."""
    rng = np.random.default_rng(41)
    found, refused = 0, 0
    for _ in range(10):
        patch, load, laws = curved_face(rng, friction=0.5, eccentric=2.0, motions=3)
        laws = laws[:1]
        R, T, q = patch.normal_modes, patch.force_modes, 6.0
        try:
            least = least_wear_dissipation(patch.weights, R, T, load, laws, patch.speed, q)
        except ComputationError:
            refused += 1
            continue
        opposed, approach = T @ least.multipliers, R @ least.multipliers
        part = patch.part((opposed > 0) & (approach > 0))
        factor = (opposed / approach)[(opposed > 0) & (approach > 0)]
        given = wear_dissipation(part.weights, laws, part.speed, q, factor)
        again = minimise(given, part.force_modes, load).multipliers
        np.testing.assert_allclose(again, least.multipliers, rtol=1e-6)
        found += 1
    assert found > 0
    assert refused > 0


def test_lowest_of_several_stationary_pressures():
    """requirement: W of two bodies with b < 1 is not convex; the lowest is found.

    Two patches; each body hardly wears on one of them.
    """
    weights, modes = np.array([1.0, 1.0]), np.ones((2, 1))
    for tilt in (0.8, 1.0, 1.25):
        laws, speed = [PowerWear(1.0, 0.6, -6.0), PowerWear(tilt, 0.6, 6.0)], np.array([0.5, 2.0])
        functional = wear_volume_rate(weights, laws, speed, 3.0)
        found = minimise(functional, modes, np.array([2.0]))
        trial = np.linspace(1e-6, 2 - 1e-6, 20001)
        values = functional(np.column_stack([trial, 2 - trial]))
        assert found.value <= values.min() * (1 + 1e-9)


def test_without_a_minimum():
    """requirement: a q for which there is none is refused, and says from which q on there is."""
    with pytest.raises(ComputationError, match="q = 1 must exceed 1 "):
        minimise(friction_dissipation(W, 0.3, SPEED, 1.0), DOWN, LOAD)
    with pytest.raises(ComputationError, match=r"must exceed 0\.5"):
        minimise(wear_volume_rate(W, [PowerWear(1.0, 2.0)], SPEED, 0.4), DOWN, LOAD)


def test_load_that_nothing_carries():
    modes = np.column_stack([np.ones(N), X])
    functional = friction_dissipation(W, 0.3, SPEED, 2.0)
    for load in ([-1.0, 0.0], [1.0, 1.1]):
        with pytest.raises(NotCarried):
            minimise(functional, modes, np.array(load))


def test_units_do_not_matter():
    """requirement: loads of any size."""
    functional = wear_dissipation(W, [PowerWear(1e-13, 1.5)], SPEED, 8.0)
    pressures = [minimise(functional, DOWN, load * LOAD).pressure for load in (1e-9, 1.0, 1e9)]
    for first, second in itertools.pairwise(pressures):
        np.testing.assert_allclose(second, 1e9 * first, rtol=1e-9)
