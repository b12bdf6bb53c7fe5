"""Wear of faces with layers in an implicit step."""

import numpy as np
import pytest

from thermowear.contact.wear.implicit_step import LayeredStep, WearRates
from thermowear.laws.distribution import InPlace, rings, uniform_track
from thermowear.laws.wear import LayeredWear, PowerWear

N, STEP, SPEED = 6, 4000.0, 0.1
LAYERED = LayeredWear((2e-6,), (PowerWear(1e-14), PowerWear(9e-14)))
OTHER = PowerWear(3e-15, 1.2)
PRESSURE = np.array([1e6, 2e6, 4e6, 6e6, 7e6, 0.5e6])
BEFORE = np.array([[1e-6, 0.0, 1.5e-6, 2e-6, 3e-6, 0.0], np.zeros(N)])


def layered_step(spread, before=BEFORE, step=STEP):
    state = (np.full(N, SPEED), *np.zeros((3, N)))
    factors = np.array([np.linspace(0.8, 1.2, N), np.ones(N)])
    rates = WearRates([LAYERED, OTHER], [spread, InPlace()], factors, [state] * 2, step)
    return LayeredStep(rates, before)


RINGS = rings(np.repeat([0.01, 0.02, 0.03], 2), np.ones(N), 0.4)
TRACK = uniform_track(np.full(N, 0.02))


@pytest.mark.parametrize("spread", [InPlace(), RINGS])
def test_slope_is_the_derivative_of_the_depth(spread):
    """
    requirement: the derivative by all pressures, in place and with means along a track.
    """
    before = BEFORE.copy()
    if spread is RINGS:  # points of a ring have one depth
        before[0] = np.repeat([0.0, 1.5e-6, 3e-6], 2)
    step = layered_step(spread, before)
    slope, exact = step.slope(PRESSURE), np.zeros((N, N))
    for point in range(N):
        change = np.zeros(N)
        change[point] = 1.0
        exact[:, point] = np.subtract(*(step.value(PRESSURE + s * change) for s in (1, -1))) / 2
    found = np.array([slope @ unit for unit in np.eye(N)]).T
    np.testing.assert_allclose(found, exact, atol=1e-6 * exact.max())


def test_a_plain_law_beside_a_layered_one():
    """
    requirement: a body without layers wears as ever, and the gap opens by both.
    """
    step = layered_step(InPlace())
    depths = step.depths(PRESSURE)
    np.testing.assert_allclose(depths[1], STEP * 3e-15 * PRESSURE**1.2 * SPEED, rtol=1e-13)
    np.testing.assert_allclose(step.value(PRESSURE), depths.sum(axis=0), rtol=1e-15)


def test_a_whole_track_loses_its_layer_at_once():
    """
    requirement: at the mean pressure along the track; Σ d/k is its dose.
    """
    step = layered_step(TRACK, np.zeros((2, N)), 4e5)
    depth = step.depths(PRESSURE)[0]
    assert np.ptp(depth) == pytest.approx(0.0, abs=1e-20)
    mean = 0.02 * SPEED * float(np.linspace(0.8, 1.2, N) @ PRESSURE)
    coating, substrate = LAYERED.worn(depth)
    dose = coating / 1e-14 + substrate / 9e-14
    np.testing.assert_allclose(dose, 4e5 * mean, rtol=1e-12)
    assert substrate.min() > 0.0
