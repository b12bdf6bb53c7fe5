"""Thermoelastic instability of a half-plane, against eigenvalues of a deep body by polynomials."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import legendre

from thermowear.reference.instability import ConductorOnInsulator

E, ν = 2.1e11, 0.3
PAIR = ConductorOnInsulator(
    wave_length=0.02,
    modulus=E / (1 - ν**2),
    poisson_ratio=ν,
    expansion=1.2e-5,
    conductivity=50.0,
    friction=0.3,
    capacity=3.7e6,
)


def fastest(pair, speed, degree=40, waves=1.6):
    """Growth rate of temperature and worn depth over a rigid insulator.

    Displacements ``(U sin m x, V cos m x)`` and temperature ``T cos m x`` are polynomials of the
    depth, held at the bottom. The face stays on the insulator: ``V = -W``.
    """
    m, depth = pair.wave_number, waves * pair.wave_length
    t, w = legendre.leggauss(degree + 4)
    y, w = depth * (1 + t) / 2, depth / 2 * w
    P = legendre.legvander(t, degree)
    dP = np.column_stack([legendre.legval(t, legendre.legder(row)) for row in np.eye(degree + 1)])
    N, dN = (1 - y / depth)[:, None] * P, -P / depth + (1 - y / depth)[:, None] * dP * 2 / depth
    face = legendre.legvander(np.array([-1.0]), degree)[0]
    n, zero = degree + 1, np.zeros_like(N)

    strains = np.stack(  # xx, yy, 2 xy
        [np.hstack([m * N, zero]), np.hstack([zero, dN]), np.hstack([dN, -m * N])]
    )
    μ, λ = E / (2 * (1 + ν)), E * ν / ((1 + ν) * (1 - 2 * ν))
    law = np.array([[λ + 2 * μ, λ, 0], [λ, λ + 2 * μ, 0], [0, 0, μ]])
    stiffness = np.einsum("aqi,ab,q,bqj->ij", strains, law, w, strains)
    prevented = (3 * λ + 2 * μ) * pair.expansion
    load = prevented * np.einsum("aqi,q,qj->ij", strains[:2], w, N)
    push = np.concatenate([np.zeros(n), face])
    flexible = np.linalg.solve(stiffness, np.column_stack([load, push]))
    lifted, pressed = push @ flexible[:, :-1], push @ flexible[:, -1]
    pressure = -np.append(lifted, 1.0) / pressed  # per temperatures and worn depth

    capacity = pair.capacity * N.T @ (w[:, None] * N)
    conducted = pair.conductivity * (dN.T @ (w[:, None] * dN) + m**2 * N.T @ (w[:, None] * N))
    rates = np.zeros((n + 1, n + 1))
    heated = np.outer(face, pair.friction * speed * pressure)
    heated[:, :-1] -= conducted
    rates[:-1] = np.linalg.solve(capacity, heated)
    rates[-1] = pair.wear * speed * pressure
    found = np.linalg.eigvals(rates if pair.wear else rates[:-1, :-1])
    best = found[np.argmax(found.real)]
    return complex(best.real, abs(best.imag))


def test_critical_speed():
    """requirement: ``2 k m/(mu α (1 + ν) E*)``; nothing grows there, and above it does."""
    v = PAIR.critical_speed
    assert v == pytest.approx(4 * np.pi * 50 * (1 - ν) / (0.02 * 0.3 * 1.2e-5 * E), rel=1e-12)
    scale = PAIR.conductivity / PAIR.capacity * PAIR.wave_number**2
    assert abs(fastest(PAIR, v)) < 1e-5 * scale
    assert PAIR.growth_rate(v) == pytest.approx(0.0, abs=1e-12 * scale)
    shorter = replace(PAIR, wave_length=PAIR.wave_length / 2)
    assert shorter.critical_speed == pytest.approx(2 * v)


@pytest.mark.parametrize("wear", [0.0, 1e-15, 3e-14, 1e-12])
@pytest.mark.parametrize("part", [0.7, 1.0, 1.1, 1.5, 3.0])
def test_growth_rate(part, wear):
    """requirement: the largest eigenvalue of conduction, elasticity and wear of a deep body."""
    pair = replace(PAIR, wear=wear)
    speed = part * pair.critical_speed
    expected, found = fastest(pair, speed), pair.growth_rate(speed)
    scale = pair.conductivity / pair.capacity * pair.wave_number**2
    assert abs(found - expected) < 1e-4 * scale


def test_elastic_insulator():
    """requirement: two bodies of the same stiffness flatten twice as much."""
    both = replace(PAIR, modulus=PAIR.modulus / 2)
    assert both.critical_speed == pytest.approx(2 * PAIR.critical_speed)
    assert both.growth_rate(2 * both.critical_speed) == pytest.approx(
        PAIR.growth_rate(2 * PAIR.critical_speed)
    )
