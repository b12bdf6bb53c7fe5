"""Jaeger's moving band against quadrature, and against a balance of heat."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar
from scipy.special import k0e

from thermowear.reference.heat import PEAKS, MovingBand

FLUX, HALF_WIDTH, CONDUCTIVITY, DIFFUSIVITY = 3e6, 0.8e-3, 45.0, 1.2e-5


def band(length):
    speed = 2 * DIFFUSIVITY * length / HALF_WIDTH
    return MovingBand(FLUX, HALF_WIDTH, speed, CONDUCTIVITY, DIFFUSIVITY)


def hottest_place(source):
    """Position x of the largest temperature, between the rear edge and the middle [m].

    The contributions of both edges are equal there, ``exp(-a) K0(a) = exp(c) K0(c)``, at the
    distances a from the rear one and ``c = 2 L - a`` from the front one.
    """
    L = source.length

    def edges(a):
        return 2 * a + np.log(k0e(2 * L - a)) - np.log(k0e(a))

    a = brentq(edges, 1e-12 * L, L, xtol=1e-15 * L, rtol=1e-14)
    return (a / L - 1) * source.half_width


def peak(source):
    """Largest temperature rise of the surface [K]."""
    return float(source.rise(hottest_place(source)))


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
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-12 * peak(source)), part


@pytest.mark.parametrize("L", PEAKS)
def test_largest_temperature(L):
    """requirement: 3.8, largest temperature over its scale by L."""
    source = band(L)
    assert peak(source) / source.scale == pytest.approx(PEAKS[L], abs=6e-7)
    found = minimize_scalar(
        lambda a: -by_quadrature((a - 1) * L, L),
        bounds=(0, 1),
        method="bounded",
        options={"xatol": 1e-7},
    )
    assert -found.fun == pytest.approx(PEAKS[L], rel=1e-6)
    assert hottest_place(source) / HALF_WIDTH == pytest.approx(found.x - 1, abs=1e-4)


def test_fast_source():
    """requirement: where all heat goes straight down, a point warms by √t under the source."""
    fast = band(2e5)
    passing = 2 * HALF_WIDTH / fast.speed
    expected = 2 * FLUX / CONDUCTIVITY * np.sqrt(DIFFUSIVITY * passing / np.pi)
    assert peak(fast) == pytest.approx(expected, rel=1e-4)
    x = np.array([0.9, 0.0, -0.5]) * HALF_WIDTH
    exposed = (HALF_WIDTH - x) / (2 * HALF_WIDTH)
    np.testing.assert_allclose(fast.rise(x), expected * np.sqrt(exposed), rtol=1e-4)
    assert np.abs(fast.rise(1.001 * HALF_WIDTH)) < 1e-9 * peak(fast)


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
