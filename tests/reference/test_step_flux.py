"""Half-spaces under a constant flux against their differential equation, by finite differences."""

from math import inf

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import solve_banded

from thermowear.reference.heat import HalfSpace, surface_rises

STEEL, LINING = HalfSpace(50.0, 3.6e6), HalfSpace(0.9, 2.1e6)
FLUX = 2e5


def share(first, second):
    """Fraction of the friction heat into the first one for equal surface temperatures."""
    return first.effusivity / (first.effusivity + second.effusivity)


def test_conduction_below_the_surface():
    """requirement: the equation of heat, the flux at the surface, and all heat is stored."""
    t, z = 3.0, np.linspace(0.0, 0.02, 5)
    dt, dz = 1e-3, 1e-5
    rate = (STEEL.rise(FLUX, t + dt, z) - STEEL.rise(FLUX, t - dt, z)) / (2 * dt)
    inside = [STEEL.rise(FLUX, t, z[1:] + shift) for shift in (-dz, 0.0, dz)]
    np.testing.assert_allclose(
        STEEL.diffusivity * np.diff(inside, 2, axis=0)[0] / dz**2, rate[1:], rtol=1e-4
    )
    below = [float(STEEL.rise(FLUX, t, k * dz)) for k in range(3)]
    slope = (-3 * below[0] + 4 * below[1] - below[2]) / (2 * dz)
    assert -STEEL.conductivity * slope == pytest.approx(FLUX, rel=1e-5)
    stored = STEEL.capacity * quad(lambda z: float(STEEL.rise(FLUX, t, z)), 0, 0.2, limit=200)[0]
    assert stored == pytest.approx(FLUX * t, rel=1e-8)
    surface = 2 * FLUX / STEEL.conductivity * np.sqrt(STEEL.diffusivity * t / np.pi)
    assert STEEL.rise(FLUX, t) == pytest.approx(surface, rel=1e-14)
    assert surface == pytest.approx(2 * FLUX * np.sqrt(t / np.pi) / STEEL.effusivity, rel=1e-14)


def test_perfect_contact():
    """requirement: both faces equally warm, whatever the partition; heat in parts of effusivity."""
    t = np.array([0.1, 1.0, 30.0])
    first, second = surface_rises((STEEL, LINING), FLUX, t, partition=0.2)
    np.testing.assert_allclose(first, second, rtol=1e-13)
    np.testing.assert_allclose(first, STEEL.rise(share(STEEL, LINING) * FLUX, t), rtol=1e-13)
    assert share(STEEL, LINING) + share(LINING, STEEL) == pytest.approx(1.0)
    assert share(STEEL, LINING) == pytest.approx(0.9070, abs=1e-4)


@pytest.mark.parametrize(("partition", "conductance"), [(0.5, 3e3), (0.0, 2e4), (0.8, 10.0)])
def test_contact_that_resists(partition, conductance):
    """requirement: implicit finite differences of both bodies in steps that grow with time."""
    end = 2.0
    expected = _differences((STEEL, LINING), partition, conductance, end)
    found = surface_rises((STEEL, LINING), FLUX, end, partition, conductance)
    np.testing.assert_allclose(found, expected, rtol=2e-3)
    nearly = surface_rises((STEEL, LINING), FLUX, end, partition, 1e9)
    np.testing.assert_allclose(
        nearly, surface_rises((STEEL, LINING), FLUX, end, partition, inf), rtol=1e-4
    )


def _differences(bodies, partition, conductance, end, cells=600, steps=2000):
    """Temperatures of both faces at a time; one chain of cells from body 1 through the contact."""
    sizes = [
        6 * np.sqrt(b.diffusivity * end) * np.diff(np.linspace(0, 1, cells + 1) ** 2)
        for b in bodies
    ]
    links, stored = [], []
    for body, h in zip(bodies, sizes, strict=True):
        nodes = np.concatenate([[h[0]], h[:-1] + h[1:], [h[-1]]]) / 2  # of linear elements, lumped
        links.append(body.conductivity / h)
        stored.append(body.capacity * nodes)
    link = np.concatenate([links[0][::-1], [conductance], links[1]])
    capacity = np.concatenate([stored[0][::-1], stored[1]])
    source = np.zeros(len(capacity))
    source[cells : cells + 2] = FLUX * partition, FLUX * (1 - partition)
    T = np.zeros(len(capacity))
    times = end * np.linspace(0, 1, steps + 1) ** 2
    for dt in np.diff(times):
        band = np.zeros((3, len(T)))
        band[0, 1:] = band[2, :-1] = -link
        band[1] = capacity / dt
        band[1, :-1] += link
        band[1, 1:] += link
        T = solve_banded((1, 1), band, capacity / dt * T + source)
    return T[cells], T[cells + 1]
