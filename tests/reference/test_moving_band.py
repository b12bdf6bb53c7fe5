"""Jaeger's moving band against quadrature, and against a balance of heat."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from scipy.special import k0e

from thermowear.reference.half_space import PEAKS, MovingBand

FLUX, HALF_WIDTH, CONDUCTIVITY, DIFFUSIVITY = 3e6, 0.8e-3, 45.0, 1.2e-5


def band(length):
    speed = 2 * DIFFUSIVITY * length / HALF_WIDTH
    return MovingBand(FLUX, HALF_WIDTH, speed, CONDUCTIVITY, DIFFUSIVITY)


def by_quadrature(place, L):
    """Rise over its scale at X, by K0."""

    def source(u):
        return float(np.exp(-u - abs(u)) * k0e(abs(u)))

    # as t³ beside the singular point, which the logarithm of K0 makes
    start, end = place - L, place + L
    if start * end >= 0:
        return quad(source, start, end, epsabs=0, epsrel=1e-12, limit=500)[0]
    return sum(
        quad(
            lambda t, way: 3 * t**2 * source(way * t**3),
            *(0.0, abs(side) ** (1 / 3)),
            args=(way,),
            epsrel=1e-12,
            limit=500,
        )[0]
        for way, side in ((-1, start), (1, end))
    )


@pytest.mark.parametrize("L", [0.1, 1.0, 10.0, 100.0])
def test_surface_by_quadrature(L):
    """requirement: the integral of K0 at points of the surface, and where it is hottest."""
    source = band(L)
    for part in (-3.0, -1.0, -0.7, 0.0, 0.4, 1.0, 1.3):
        expected = source.scale * by_quadrature(part * L, L)
        found = source.rise(part * HALF_WIDTH)
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-12 * source.peak), part


@pytest.mark.parametrize("L", PEAKS)
def test_largest_temperature(L):
    """requirement: 3.8, largest temperature over its scale by L."""
    source = band(L)
    assert source.peak / source.scale == pytest.approx(PEAKS[L], abs=6e-7)
    found = minimize_scalar(
        lambda a: -by_quadrature((a - 1) * L, L),
        bounds=(0, 1),
        method="bounded",
        options={"xatol": 1e-7},
    )
    assert -found.fun == pytest.approx(PEAKS[L], rel=1e-6)
    assert source.hottest_place / HALF_WIDTH == pytest.approx(found.x - 1, abs=1e-4)


def test_fast_source():
    """requirement: where all heat goes straight down, a point warms by √t under the source."""
    fast = band(2e5)
    passing = 2 * HALF_WIDTH / fast.speed
    peak = 2 * FLUX / CONDUCTIVITY * np.sqrt(DIFFUSIVITY * passing / np.pi)
    assert fast.peak == pytest.approx(peak, rel=1e-4)
    x = np.array([0.9, 0.0, -0.5]) * HALF_WIDTH
    exposed = (HALF_WIDTH - x) / (2 * HALF_WIDTH)
    np.testing.assert_allclose(fast.rise(x), peak * np.sqrt(exposed), rtol=1e-4)
    assert np.abs(fast.rise(1.001 * HALF_WIDTH)) < 1e-9 * fast.peak


def test_heat_carried_away():
    """requirement: far behind, all heat has spread as from a line that gave it at once."""
    source = band(5.0)
    x = -1e5 * HALF_WIDTH
    heat = 2 * HALF_WIDTH * FLUX / source.speed  # per area, per length along the band
    time = -x / source.speed
    capacity = CONDUCTIVITY / DIFFUSIVITY
    expected = (
        heat * source.speed / (CONDUCTIVITY * np.sqrt(np.pi * source.speed * -x / DIFFUSIVITY))
    )
    assert source.rise(x) == pytest.approx(expected, rel=1e-4)
    sheet = heat / (capacity * np.sqrt(np.pi * DIFFUSIVITY * time))
    assert source.rise(x) == pytest.approx(sheet, rel=1e-4)
