"""Wear through layers: exact depths at constant rates, laws by depth."""

import numpy as np
import pytest

from thermowear.laws import LocalState, PowerWear
from thermowear.laws.wear import LayeredWear, layers_of

THICKNESS = (5e-6, 2e-6)
LAWS = (PowerWear(2e-14), PowerWear(6e-17, 1.3), PowerWear(8e-13, 0.8, 0.5))
LAYERED = LayeredWear(THICKNESS, LAWS)
VARYING = LayeredWear(THICKNESS, LAWS, 0.8e-6)
"""Depths that vary in the area of each point."""
DEPTHS = np.array([0.0, 1e-6, 4.999e-6, 5e-6, 6.5e-6, sum(THICKNESS), 9e-6, 2e-6])
COEFFICIENTS = (2e-14, 4e-14, 1e-13)
STATE = LocalState(p=np.array([1e6, 2e6, 3e6, 4e6, 5e6, 6e6, 7e6, 0.0]), v=0.1)
RATES = np.array([law.value(STATE) for law in LAWS])


def marched(depth, rate, time, steps=20_000):
    """Depth by many small steps at the rate of the layer reached."""
    for _ in range(steps):
        depth = depth + time / steps * rate(depth)
    return depth


@pytest.mark.parametrize("layered", [LAYERED, VARYING])
@pytest.mark.parametrize("time", [10.0, 2e3, 2e4])
def test_passage_against_many_small_steps(layered, time):
    """
    requirement: d' = r(d), whatever number of layers a point passes in the time.
    """
    found = layered.passage(DEPTHS, RATES, time)
    end = marched(DEPTHS, lambda d: layered.value(STATE._replace(depth=d)), time)
    np.testing.assert_allclose(DEPTHS + found.depth, end, rtol=2e-4)
    np.testing.assert_allclose(found.spent.sum(axis=0), time, rtol=1e-14)
    # each layer is worn by no more than it has left, and the times tell the depths
    worn = layered.worn(DEPTHS + found.depth) - layered.worn(DEPTHS)
    np.testing.assert_allclose(found.shares.T @ found.gained, worn, rtol=1e-9, atol=1e-20)
    np.testing.assert_allclose(found.gained, found.spent * found.mixed, rtol=1e-12)
    assert found.depth[-1] == 0.0  # without pressure


@pytest.mark.parametrize("layered", [LAYERED, VARYING])
def test_passages_follow_one_another(layered):
    """
    requirement: two passages are the one of both times.
    """
    first = layered.passage(DEPTHS, RATES, 700.0).depth
    both = first + layered.passage(DEPTHS + first, RATES, 5300.0).depth
    np.testing.assert_allclose(both, layered.passage(DEPTHS, RATES, 6e3).depth, rtol=1e-12)


@pytest.mark.parametrize("layered", [LAYERED, VARYING])
@pytest.mark.parametrize("layer", range(3))
def test_derivative_by_the_rate_of_each_layer(layered, layer):
    """
    requirement: a layer left sooner leaves more time to the last one.
    """
    step = np.zeros_like(RATES)
    step[layer] = 1e-6 * RATES[layer]
    ends = [layered.passage(DEPTHS, RATES + sign * step, 6e3).depth for sign in (1, -1)]
    slope = layered.passage(DEPTHS, RATES, 6e3).by_rate[layer]
    wears = RATES[layer] > 0
    found = np.subtract(*ends)[wears] / (2 * step[layer][wears])
    np.testing.assert_allclose(slope[wears], found, rtol=1e-6, atol=1e-3)


@pytest.mark.parametrize("variation", [0.0, 0.8e-6, np.linspace(0, 3e-6, 5)])
def test_laws_that_differ_by_a_coefficient_follow_the_dose(variation):
    """
    requirement: Σ d_i/k_i is the dose ∫ p v dt, for any history of the pressure.
    """
    layered = LayeredWear(THICKNESS, tuple(PowerWear(k) for k in COEFFICIENTS), variation)
    depth, dose = np.zeros(5), np.zeros(5)
    for pressure in np.random.default_rng(1).uniform(0, 9e6, (40, 5)):
        at = LocalState(pressure, 0.1)
        rates = np.array([law.value(at) for law in layered.laws])
        depth = depth + layered.passage(depth, rates, 30.0).depth
        dose += 30.0 * 0.1 * pressure
    assert depth.min() > sum(THICKNESS)
    done = layered.worn(depth).T @ (1 / np.array(COEFFICIENTS))
    np.testing.assert_allclose(done, dose, rtol=1e-13)


def test_a_border_that_passes_a_point():
    """
    requirement: both materials wear at one rate there, under pressures whose mean is that of the
    point, with the share of the layer that the hat function has; half of it when it is in the
    middle, and none of the layer is left when it has passed.
    """
    layered = LayeredWear((5e-6,), (PowerWear(1e-14), PowerWear(1e-13)), 1e-6)
    depth = np.linspace(4.4e-6, 5.6e-6, 2401)
    rate = layered.value(LocalState(np.full(len(depth), 1e6), 0.1, depth=depth))
    share = (1e6 * 0.1 / rate - 1e13) / (1e14 - 1e13)  # from p = r (f/k_1 + (1 - f)/k_2) / v
    u = ((depth - 5e-6) / 0.5e-6).clip(-1, 1)
    np.testing.assert_allclose(share, 0.5 - u + u * np.abs(u) / 2, atol=1 / 16)
    assert share[[0, -1]] == pytest.approx([1.0, 0.0], abs=1e-12)
    assert np.diff(share).max() < 1e-9
    coating, substrate = layered.worn(np.array([5.5e-6]))
    assert coating == pytest.approx(5e-6, rel=1e-12)
    assert substrate == pytest.approx(0.5e-6, rel=1e-12)


def test_law_by_depth():
    """
    requirement: value and slope are those of the layer reached; a border belongs to the next one.
    """
    at = STATE._replace(depth=DEPTHS)
    layer = np.array([0, 0, 0, 1, 1, 2, 2, 0])
    assert np.array_equal(LAYERED.reached(DEPTHS), layer)
    points = np.arange(len(layer))
    np.testing.assert_array_equal(LAYERED.value(at), RATES[layer, points])
    slopes = np.array([law.slope(at) for law in LAWS])
    np.testing.assert_array_equal(LAYERED.slope(at), slopes[layer, points])
    assert LAYERED.variables == {"p", "v", "depth"}
    assert LAYERED.inner_variables == {"p", "v"}


def test_a_plain_law_has_no_layers():
    law = PowerWear(1e-13)
    plain = layers_of(law)
    assert plain.substrate is law
    assert not plain.thickness
    assert plain.variables == law.variables
    assert layers_of(LAYERED) is LAYERED
    at = LocalState(np.full(2, 1e6), 0.1)
    depth = plain.passage(np.array([0.0, 1.0]), law.value(at)[None], 10.0).depth
    np.testing.assert_allclose(depth, 10.0 * law.value(at), rtol=1e-15)
