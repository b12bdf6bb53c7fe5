"""The principle of minimum wear dissipation power."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import fsolve

from thermowear import ComputationError
from thermowear.laws import (
    LocalState,
    PowerWear,
    admissible_changes,
    contact_patch,
    rotation,
    steady_pressure,
    translation,
    wear_dissipation,
)
from thermowear.reference import annular_punch

from ..conftest import examples
from .random_problems import curved_face, flat_face

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
    r, _, steady = solve_ring([PowerWear(5e-14 * 1e6 ** (1 - b), b, a)])
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
    r, weights, steady = solve_ring([PowerWear(5e-14 * 1e6 ** (1 - b), b)], force)
    assert weights @ (steady.pressure * r) * 1e3 == pytest.approx(torque, rel=2e-5)


def test_both_bodies_wear_with_different_exponents():
    """requirement: with b1 ≠ b2 the sum of both rates equals the rigid-body rate point by point."""
    laws = [PowerWear(5e-14, 1.0), PowerWear(2e-21, 2.0)]
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
            w, modes, modes, load, [PowerWear(1e-10 * 1e6 ** (1 - b), b)], np.full(30, 5e-3)
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
        [PowerWear(1e-13 * 1e6 ** (1 - b), b)], np.ones(40),
    )  # fmt: skip
    scale = steady.pressure / z ** (1 / b)
    np.testing.assert_allclose(scale, scale[0], rtol=1e-12)
    ends = scale[0] * np.array([0.05, 0.15]) ** (1 / b) / 1e6
    assert ends == pytest.approx([low, high], rel=2e-6)


def test_lifts_off_where_the_rigid_rate_is_negative():
    """requirement: p = 0 where V·n < 0; a load outside the kernel lifts one side off."""
    x, w = np.polynomial.legendre.leggauss(200)
    modes = np.column_stack([np.ones_like(x), x])
    steady = steady_pressure(w, modes, modes, np.array([1.0, 0.6]), [PowerWear(1.0)], np.ones(200))
    zone = 3 * (1 - 0.6)
    assert np.all(steady.pressure[x < 1 - zone - 0.02] == 0)
    exact = np.maximum(0, 2 / zone**2 * (x - (1 - zone)))
    assert np.abs(steady.pressure - exact).max() < 0.01 * exact.max()


def dissipation(pressure, weights, law, speed):
    return weights @ (pressure * law.value(LocalState(pressure, speed)))


@settings(max_examples=examples(80), deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1), b=st.sampled_from([0.5, 1.0, 2.0]), size=st.floats(1e-3, 0.5)
)
def test_no_admissible_change_lowers_the_dissipation(seed, b, size):
    """requirement: the solution is the minimum of D_w among pressures in equilibrium."""
    law = PowerWear(5e-14 * 1e6 ** (1 - b), b)
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
    with pytest.raises(ComputationError, match="sliding speed is 0"):
        steady_pressure(weights, down, down, np.ones(1), [PowerWear(1.0)], r * 0)


def test_nothing_to_wear_or_to_press():
    """requirement: no wearing body and no load are said."""
    r, weights = ring(5)
    down = np.ones((5, 1))
    with pytest.raises(ComputationError, match="no body has a wear law"):
        steady_pressure(weights, down, down, np.ones(1), [], r)
    with pytest.raises(ComputationError, match="no contact pressure is in equilibrium"):
        steady_pressure(weights, down, down, np.zeros(1), [PowerWear(1.0)], r)


def check_all_conditions(patch, load, laws, steady):
    """Wear, parting, equilibrium and power, each from its definition."""
    p, R, T = steady.pressure, patch.normal_modes, patch.force_modes
    rates = sum(law.value(LocalState(p, patch.speed)) for law in laws)
    approach = R @ steady.velocity
    scale = np.abs(approach).max()
    touching = p > 0
    assert np.all(p >= 0)
    assert touching.any()
    np.testing.assert_allclose(rates[touching], approach[touching], atol=1e-11 * scale)
    assert approach[~touching].max(initial=0.0) < 1e-11 * scale
    moments = np.abs(T * patch.weights[:, None]).T @ p
    np.testing.assert_allclose((T * patch.weights[:, None]).T @ p, load, atol=1e-10 * moments.max())
    power = load @ steady.velocity
    assert steady.dissipation == pytest.approx(
        power, abs=1e-9 * np.abs(load) @ np.abs(steady.velocity)
    )


@pytest.mark.parametrize("problem", [flat_face, curved_face])
@pytest.mark.parametrize("eccentric", [0.0, 3.0, 8.0])
def test_random_admissible_problems(problem, eccentric):
    """requirement: convergent from a fixed start for random admissible problems.

    One to three motions about pivots anywhere, one or two bodies with exponents from 0.3 to 4,
    friction up to 0.4 in any direction, faces that part by up to nine tenths.
    """
    rng = np.random.default_rng(int(100 + eccentric))
    parted = []
    for _ in range(150):
        patch, load, laws = problem(rng, friction=0.4, eccentric=eccentric)
        steady = patch.steady(load, laws)
        check_all_conditions(patch, load, laws, steady)
        parted.append(np.mean(steady.pressure == 0))
    if eccentric == 8:
        assert np.quantile(parted, 0.9) > 0.6
        assert np.mean(np.array(parted) > 0) > 0.3


def test_friction_and_tilt_against_another_solver():
    """requirement: equilibrium with ``n + mu e``, kinematics with n alone."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        patch, load, laws = curved_face(rng, friction=0.3, eccentric=0.5)
        steady = patch.steady(load, laws)
        if len(laws) == 2 or np.any(steady.pressure == 0):
            continue
        R, T, factor = patch.normal_modes, patch.force_modes, laws[0].factor(patch.speed)
        scale = np.abs(steady.velocity)

        def imbalance(x, R=R, T=T, patch=patch, law=laws[0], factor=factor, load=load, s=scale):
            p = np.maximum(R @ (x * s) / factor, 0.0) ** (1 / law.pressure_exponent)
            return (T.T @ (patch.weights * p) - load) / np.abs(load)

        found = fsolve(imbalance, steady.velocity / scale * 1.05, xtol=1e-13)
        np.testing.assert_allclose(found * scale, steady.velocity, rtol=1e-8)


def symmetric_arc(friction, b=2.0, sense=1):
    x, w = np.polynomial.legendre.leggauss(60)
    α = 0.5 * x
    outward = np.column_stack([np.sin(α), np.cos(α)])
    patch = contact_patch(
        0.02 * outward, 0.5 * w * 0.02 * 0.01, -outward, [translation((0, -1))], 0.3,
        friction, sense * np.column_stack([np.cos(α), -np.sin(α)]),
    )  # fmt: skip
    return α, patch, patch.steady([1000.0], [PowerWear(1e-19, b)])


@pytest.mark.parametrize("b", [0.5, 1.0, 3.0])
def test_friction_drops_out_of_the_symmetric_arc(b):
    """requirement: p independent of mu to 1e-10; the guide bears mu F, its sign with the sense."""
    α, _, without = symmetric_arc(0.0, b)
    for friction in (0.1, 0.3, 0.9):
        for sense in (1, -1):
            _, patch, steady = symmetric_arc(friction, b, sense)
            np.testing.assert_allclose(steady.pressure, without.pressure, rtol=1e-10)
            force = patch.force(steady.pressure)
            assert force[0] == pytest.approx(sense * friction * 1000, rel=1e-10)
            assert force[1] == pytest.approx(-1000, rel=1e-10)
    np.testing.assert_allclose(
        without.pressure, without.pressure.max() * (np.cos(α) / np.cos(α).max()) ** (1 / b)
    )


def test_friction_moves_the_pressure_of_a_tilting_block():
    """requirement: friction enters through the moment ``mu h F``, with the sign of the sense."""
    x, w = np.polynomial.legendre.leggauss(40)
    z, h, mu, force, length = 0.05 * x, 0.03, 0.4, 1e3, 0.1
    for sense in (1, -1):
        patch = contact_patch(
            np.column_stack([np.full(40, h), 0 * z, z]), 0.05 * w * 0.01, (1, 0, 0),
            [translation((1, 0, 0)), rotation((0, 1, 0), (0, 0, 0))], 1.0, mu, (0, 0, -sense),
        )  # fmt: skip
        steady = patch.steady([force, 0.0], [PowerWear(1e-13)])
        moment = -sense * mu * h * force
        exact = force / (0.01 * length) + 12 * moment * z / (0.01 * length**3)
        np.testing.assert_allclose(steady.pressure, exact, rtol=1e-11)


def test_pivots_and_units_do_not_matter():
    """requirement: the same body held at another pivot has the same pressure."""
    rng = np.random.default_rng(8)
    patch, load, laws = curved_face(rng, friction=0.2, eccentric=3.0, motions=3)
    steady = patch.steady(load, laws)
    arm = np.array([0.3, -5.0, patch.motions[1].pivot[2]])
    moved = [
        translation(1e3 * m.translation) if np.any(m.translation) else rotation(m.rotation, arm)
        for m in patch.motions
    ]
    other = contact_patch(
        patch.points, patch.weights, patch.normals, moved, patch.speed, 1.0,
        patch.traction - patch.normals,
    )  # fmt: skip
    load = other.force_modes.T @ (patch.weights * steady.pressure)
    found = other.steady(load, laws).pressure
    np.testing.assert_allclose(found, steady.pressure, atol=1e-9 * found.max())


def test_probes_bear_nothing():
    """requirement: points without area are solved for and change nothing."""
    rng = np.random.default_rng(9)
    patch, load, laws = curved_face(rng, friction=0.3, eccentric=6.0, motions=2)
    without = patch.part(np.arange(len(patch.weights)) % 3 > 0)
    load = without.force_modes.T @ (without.weights * 1e6)
    alone = without.steady(load, laws)
    weights = np.where(np.arange(len(patch.weights)) % 3 > 0, patch.weights, 0.0)
    steady = steady_pressure(
        weights, patch.normal_modes, patch.force_modes, load, laws, patch.speed
    )
    np.testing.assert_allclose(steady.velocity, alone.velocity, rtol=1e-10)
    rates = sum(steady.rates)
    np.testing.assert_allclose(rates, np.maximum(steady.approach, 0), atol=1e-11 * rates.max())


def test_different_exponents_minimise_what_the_docstring_says():
    """requirement: with b1 ≠ b2 the kinematics holds, not the minimum of D_w itself."""
    r, weights, steady = solve_ring([PowerWear(5e-14, 1.0), PowerWear(2e-21, 2.0, 0.5)])
    down = np.ones((len(r), 1))
    laws = [PowerWear(5e-14 / 2, 1.0), PowerWear(2e-21 / 3, 2.0, 0.5)]  # each over b + 1
    weighted = wear_dissipation(weights, laws, 10 * r)
    plain = wear_dissipation(weights, [PowerWear(5e-14), PowerWear(2e-21, 2.0, 0.5)], 10 * r)
    changes = admissible_changes(
        np.random.default_rng(1), 1000, weights, down, steady.pressure, (1e-4, 0.5)
    )
    pressures = steady.pressure + changes
    assert np.all(weighted(pressures) > weighted(steady.pressure))
    assert np.any(plain(pressures) < plain(steady.pressure))


@pytest.mark.parametrize(
    "extra",
    [translation((0, 0, 1)), rotation((1, 0, 0), (0, 0, 0.1)), translation((2, 0, 0.3))],
)
def test_motions_that_do_not_press_are_refused(extra):
    """requirement: a free direction that nothing resists has no steady state, and says so."""
    z = np.linspace(0.05, 0.15, 30)
    motions = [rotation((0, 1, 0), (0, 0, 0)), translation((1, 0, 0)), extra]
    points = np.column_stack([np.full(30, 0.04), 0 * z, z])
    patch = contact_patch(points, np.ones(30), (1, 0, 0), motions, 1.0, 0.3, (0, 0, -1))
    with pytest.raises(ComputationError, match="free motion"):
        patch.steady([10.0, 100.0, 30.0], [PowerWear(1e-13)])
