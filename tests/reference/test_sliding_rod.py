"""Thermoelastic instability of a rod, against eigenvalues of the rod by polynomials."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import legendre

from thermowear.reference.instability import SlidingRod

ROD = SlidingRod(0.05, 2.1e11, 1.2e-5, 50.0, 3.7e6, 0.3)


def eigenvalues(rod, speed, degree=24):
    """Growth rates by a Galerkin method: x = L (1 + t)/2, temperatures ``(1 + t) P_k(t)`` [1/s]."""
    t, w = legendre.leggauss(degree + 3)
    P, ends = legendre.legvander(t, degree), legendre.legvander(np.array([1.0]), degree)[0]
    slopes = np.column_stack(
        [legendre.legval(t, legendre.legder(row)) for row in np.eye(degree + 1)]
    )
    T, dT, hot = (1 + t)[:, None] * P, P + (1 + t)[:, None] * slopes, 2 * ends
    L, k, c = rod.length, rod.conductivity, rod.capacity
    stored, conducted = c * L / 2 * T.T @ (w[:, None] * T), 2 * k / L * dT.T @ (w[:, None] * dT)
    # the pressure per temperatures and per worn length
    stretch = rod.young_modulus / L
    pressure = np.append(stretch * rod.expansion * L / 2 * w @ T, -stretch)
    size = degree + 2
    rates = np.zeros((size, size))
    heated = np.outer(hot, rod.friction * speed * pressure)
    heated[:, :-1] -= conducted
    rates[:-1] = np.linalg.solve(stored, heated)
    rates[-1] = rod.wear * speed * pressure
    return np.linalg.eigvals(rates if rod.wear else rates[:-1, :-1])


def fastest(rod, speed):
    found = eigenvalues(rod, speed)
    best = found[np.argmax(found.real)]
    return complex(best.real, abs(best.imag))


def test_figures():
    """requirement: 3.10, critical speed and growth rates."""
    assert ROD.critical_speed == pytest.approx(2.6455e-3, rel=1e-4)
    assert ROD.growth_rate(1.05 * ROD.critical_speed) == pytest.approx(6.479e-4, rel=1e-4)
    assert ROD.growth_rate(2 * ROD.critical_speed) == pytest.approx(0.012700, rel=5e-5)
    worn = replace(ROD, wear=1e-14)
    assert worn.growth_rate(2 * ROD.critical_speed) == pytest.approx(0.012256, rel=5e-5)


@pytest.mark.parametrize("wear", [0.0, 1e-15, 1e-14, 3e-13, 2e-12])
@pytest.mark.parametrize("part", [0.3, 0.9, 1.0, 1.03, 1.3, 2.0, 6.0])
def test_growth_rate(part, wear):
    """requirement: the largest eigenvalue of conduction, friction heat and wear of the rod."""
    rod = replace(ROD, wear=wear)
    speed = part * rod.critical_speed
    scale = rod.conductivity / rod.capacity / rod.length**2
    assert abs(rod.growth_rate(speed) - fastest(rod, speed)) < 1e-6 * scale


@pytest.mark.parametrize("wear", [0.0, 1e-14, 3e-13, 9e-13])
def test_critical_speed(wear):
    """requirement: at it nothing grows or dies out; wear raises it."""
    rod = replace(ROD, wear=wear)
    found = rod.critical_speed_with_wear
    assert found > rod.critical_speed or wear == 0.0
    scale = abs(rod.growth_rate(1.5 * found))
    assert abs(fastest(rod, found).real) < 1e-6 * scale
    assert fastest(rod, 1.01 * found).real > 0.0
    assert fastest(rod, 0.99 * found).real < 0.0


def test_pressure():
    """requirement: the rod between its end and the wall, lengthened by the steady heat."""
    speed, interference = 0.6 * ROD.critical_speed, 2e-6
    p = ROD.pressure(interference, speed)
    hot = ROD.friction * p * speed * ROD.length / ROD.conductivity
    stretch = interference + ROD.expansion * hot * ROD.length / 2
    assert p == pytest.approx(ROD.young_modulus * stretch / ROD.length, rel=1e-12)
