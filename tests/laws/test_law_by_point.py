"""Laws of a face of several materials, selected at the contact points."""

import numpy as np
import pytest

from thermowear.laws import InPlace, LocalState, PowerWear, steady_pressure, uniform_track
from thermowear.laws.formulas import wear_rate
from thermowear.laws.wear import LawByPoint, law_by_point

AT = np.array([0, 1, 1, 0, 2])
POWERS = [PowerWear(2e-13), PowerWear(3e-13 * 1e6**-0.5, 1.5, 0.5), PowerWear(5e-14, 1.0, 2.0)]
STATE = LocalState(
    p=np.array([1e6, 2e6, 0.0, 4e6, 5e6]), v=np.array([0.1, 0.2, 0.3, 0.4, 0.5]), T=300.0
)


def of_each(function):
    """Values of the laws one by one, each at its own points."""
    own = [function(law) for law in POWERS]
    return np.array([own[index][point] for point, index in enumerate(AT)])


@pytest.mark.parametrize("powers", [True, False])
def test_each_point_has_the_law_of_its_material(powers):
    """
    requirement: value and slope are those of the law at the point, in closed form or not.
    """
    law = law_by_point(POWERS, AT) if powers else LawByPoint(tuple(POWERS), AT)
    np.testing.assert_allclose(law.value(STATE), of_each(lambda one: one.value(STATE)), rtol=1e-14)
    slope = of_each(lambda one: one.slope(STATE))
    near = STATE.p > 0  # at p = 0 the slope is bounded by the largest pressure of the material
    np.testing.assert_allclose(law.slope(STATE)[near], slope[near], rtol=1e-12)
    assert law.variables == {"p", "v"}


def test_powers_stay_powers_and_a_single_law_itself():
    assert type(law_by_point(POWERS, AT)) is PowerWear
    assert law_by_point(POWERS[1:2], np.zeros(5, int)) is POWERS[1]


def test_a_derived_power_law_keeps_its_own_rate():
    """
    requirement: a class that overrides the rate is not taken for its base.
    """

    class Doubled(PowerWear):
        def value(self, at):
            return 2 * super().value(at)

    law = law_by_point([PowerWear(1e-13), Doubled(1e-13)], np.array([0, 1]))
    rate = law.value(LocalState(np.full(2, 1e6), 0.1))
    assert rate[1] == pytest.approx(2 * rate[0], abs=0.0)


def test_a_law_sees_its_own_points_only():
    """
    requirement: a law that fails in states of another material is not evaluated there.
    """
    seen = []

    def rate(p, T):
        seen.extend(np.broadcast_to(T, np.shape(p)))
        return 1e-14 * p * (1 + T / 1e3)

    hot, at = wear_rate(rate), np.array([0, 0, 1, 1])
    law = law_by_point([PowerWear(1e-13), hot], at)
    seen.clear()
    T = np.array([900.0, 900.0, 310.0, 320.0])
    found = law.value(LocalState(np.full(4, 1e6), 0.1, T))
    assert set(seen) <= {310.0, 320.0}
    np.testing.assert_allclose(found, [1e-8, 1e-8, 1.31e-8, 1.32e-8], rtol=1e-12)
    assert law.variables == {"p", "v", "T"}


@pytest.mark.parametrize("closed_form", [True, False])
def test_steady_pressure_of_two_materials(closed_form):
    """
    requirement: p_i = (V / (k_i v^a_i))^(1/b_i) with one V; under the load.
    """
    at = np.repeat([0, 1], [20, 10])
    laws = [PowerWear(2e-13), PowerWear(4e-16, 1.5, 0.5)]
    law = law_by_point(laws, at) if closed_form else LawByPoint(tuple(laws), at)
    weights, speed = np.full(30, 1e-5), np.linspace(0.1, 0.4, 30)
    modes = np.ones((30, 1))
    steady = steady_pressure(weights, modes, modes, np.array([900.0]), [law], speed)
    (V,) = steady.velocity
    expected = np.where(at == 0, V / (2e-13 * speed), (V / (4e-16 * speed**0.5)) ** (1 / 1.5))
    np.testing.assert_allclose(steady.pressure, expected, rtol=1e-11)
    assert weights @ steady.pressure == pytest.approx(900.0, rel=1e-12)
    np.testing.assert_allclose(steady.rates[0], V, rtol=1e-11)


def test_two_bodies_one_of_two_materials():
    """
    requirement: rates of both bodies add up to one velocity where their exponents differ.
    """
    at = np.repeat([0, 1], 15)
    upper = law_by_point([PowerWear(2e-13), PowerWear(4e-16, 1.5)], at)
    weights, speed, modes = np.full(30, 1e-5), np.full(30, 0.1), np.ones((30, 1))
    laws = [upper, PowerWear(1e-13)]
    steady = steady_pressure(weights, modes, modes, np.array([900.0]), laws, speed)
    p = steady.pressure
    total = np.where(at == 0, 2e-13 * p, 4e-16 * p**1.5) * 0.1 + 1e-14 * p
    np.testing.assert_allclose(total, steady.velocity[0], rtol=1e-11)
    assert np.ptp(p[:15]) < 1e-9 * p[0]
    assert abs(p[0] / p[-1] - 1) > 0.1


def test_two_materials_on_a_body_that_wears_along_its_track():
    """
    requirement: the track wears uniformly by the mean, and the pressures keep the ratio of 1/k.
    """
    at, weights = np.repeat([0, 1], [20, 10]), np.full(30, 1e-5)
    pad = law_by_point([PowerWear(2e-13), PowerWear(8e-13)], at)
    speed, modes = np.full(30, 0.1), np.ones((30, 1))
    spread = [InPlace(), uniform_track(np.full(30, 1e-3))]
    laws = [pad, PowerWear(1e-13)]
    steady = steady_pressure(weights, modes, modes, np.array([900.0]), laws, speed, spread)
    p = steady.pressure
    np.testing.assert_allclose(p[at == 0], 4 * p[at == 1][0], rtol=1e-11)
    assert np.ptp(steady.rates[1]) < 1e-12 * steady.rates[1].max()
    np.testing.assert_allclose(sum(steady.rates), steady.velocity[0], rtol=1e-11)
