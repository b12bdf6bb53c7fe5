"""Heat carried round by a brake disk in space at high Péclet numbers."""

import math

import numpy as np
import pytest
from scipy.interpolate import LinearNDInterpolator

from thermowear.bulk.heat import advection

from .turning_disk import (
    CAPACITY,
    CONDUCTIVITY,
    INNER,
    LENGTH,
    MEAN,
    OUTER,
    POWER,
    circles,
    disk,
    turning,
    wiggles,
)


def on_track(result):
    """Circles of the face under the pad, see `circles`."""
    return {r: c for r, c in circles(result).items() if INNER - 1e-9 < r < OUTER + 1e-9}


def smoothness(result):
    """Largest variation round circles beyond one rise and one fall, of the mean range."""
    track = on_track(result)
    ranges = np.mean([np.ptp(rise) for _, rise in track.values()])
    return max(wiggles(rise) for _, rise in track.values()) / ranges


def means(result):
    """Means round the circles of the track, by radius [K]."""
    found = {}
    for r, (angle, rise) in on_track(result).items():
        closed = np.append(angle, angle[0] + 2 * math.pi), np.append(rise, rise[0])
        found[r] = np.trapezoid(closed[1], closed[0]) / (2 * math.pi)
    return found


def distances(result, spread):
    """Largest distances from heat spread: of means round the track, and of points; of the rise."""
    (_, rise), (_, even), mean = disk(result), disk(spread), means(spread)
    apart = max(abs(value - mean[r]) for r, value in means(result).items())
    return apart / even.max(), np.abs(rise - even).max() / even.max()


@pytest.fixture(scope="module")
def spread():
    return turning(1e5, 4, "spread")


@pytest.fixture(scope="module")
def fast():
    """Coarse runs by Péclet number."""
    return {peclet: turning(peclet, 4) for peclet in (1e3, 1e5)}


def check_smooth(result):
    rise = disk(result)[1]
    assert result.summary["heat_advection"] == "stabilised"
    assert result.summary["heat_balance_relative_error"] < 1e-9
    assert rise.min() > 0
    # hottest on the rubbed face, where heat enters
    hottest = max(values.max() for _, values in on_track(result).values())
    assert rise.max() - hottest < 1e-3 * hottest
    assert smoothness(result) < 0.01


def test_temperature_does_not_oscillate(fast):
    """
    requirement: at Péclet numbers of 1e3 and 1e5, cells of 1e2 and 1e4: nothing below ambient; on
    every circle of the track one rise, under the pad, and one fall behind it; heat balance 1e-9.
    """
    for peclet, result in fast.items():
        check_smooth(result)
        assert 0.05 < result.summary["max_cell_peclet_number"] / peclet < 0.2
        for angle, rise in on_track(result).values():
            assert -80 < math.degrees(angle[rise.argmin()]) < -10  # before it is under the pad
            assert 10 < math.degrees(angle[rise.argmax()]) < 60  # as it leaves it


def test_without_stabilisation_it_oscillates(monkeypatch):
    """requirement: the measure of oscillations sees those of standard Galerkin elements."""
    monkeypatch.setattr(advection, "_MAX_RESOLVED_PECLET", math.inf)
    assert smoothness(turning(1e5, 4)) > 0.5


def test_heat_spread_is_the_limit(fast, spread):
    """
    requirement: at a fixed friction power, the temperature tends to that of heat spread round the
    axis, pointwise about as 1/√Pe, in the mean round the axis faster.
    """
    rise = disk(spread)[1]
    for _, values in on_track(spread).values():
        assert np.ptp(values) < 1e-5 * rise.max()  # exact at nodes
    (mean, point), (mean_fast, point_fast) = (distances(fast[p], spread) for p in (1e3, 1e5))
    assert point < 0.06
    assert 0.05 < point_fast / point < 0.13  # 0.1, but for the resolution of the coarse mesh
    assert mean < 2e-3
    assert mean_fast < 1e-4


@pytest.mark.slow
def test_fine_meshes_at_both_peclet_numbers():
    """
    requirement: as on the coarse mesh; the difference from a finer mesh does not alternate from
    node to node; the flash under the pad is that of a half-space, less what the mesh resolves.
    """
    for peclet, unresolved in ((1e3, 0.1), (1e5, 0.5)):
        result, finer = turning(peclet, 12), turning(peclet, 24)
        for each in (result, finer):
            check_smooth(each)
        angle = np.linspace(-math.pi, math.pi, 181)[:-1]
        residual = on_circle(result, angle) - on_circle(finer, angle)
        jumps = np.abs(np.roll(residual, 1) - 2 * residual + np.roll(residual, -1)) / 4
        reached = np.ptp(on_circle(finer, angle))
        assert jumps.max() < 0.03 * reached
        # rise of a half-space under a uniform flux after the time under the pad, as a bound
        flux = POWER / (LENGTH * (OUTER - INNER))
        time = LENGTH**2 / (peclet * CONDUCTIVITY / CAPACITY)
        bound = 2 * flux * math.sqrt(time / (math.pi * CONDUCTIVITY * CAPACITY))
        assert (1 - unresolved) * bound < reached < 1.1 * bound


def on_circle(result, angle):
    """Rises on the mean circle of the track at angles [K], linear between points of the face."""
    points, rise = disk(result)
    x, y, z = points.T
    r, turned = np.hypot(x, y), np.arctan2(y, x)
    near = (np.abs(z) < 1e-9) & (np.abs(r - MEAN) < 0.02)
    at, values = np.column_stack([turned, 20 * r])[near], rise[near]
    at, first = np.unique(np.round(at, 8), axis=0, return_index=True)
    shifts = [(at + [2 * math.pi * turn, 0.0]) for turn in (-1, 0, 1)]
    found = LinearNDInterpolator(np.vstack(shifts), np.tile(values[first], 3))
    return found(angle, np.full(len(angle), 20 * MEAN))


@pytest.mark.slow
def test_convergence_in_the_peclet_number():
    """requirement: distances from heat spread fall with the speed, at points as 1/√Pe."""
    even = turning(1e5, 12, "spread")
    table = np.array([distances(turning(p, 12), even) for p in (1e2, 1e3, 1e4, 1e5)])
    assert np.all(np.diff(table, axis=0) < 0)
    ratios = table[:-1, 1] / table[1:, 1]
    assert np.all((ratios > 2.5) & (ratios < 5.5))
    assert table[-1, 0] < 1e-4
