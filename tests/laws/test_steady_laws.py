"""The steady principle for wear rates that are no powers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from thermowear.errors import ComputationError
from thermowear.laws import InPlace, PowerWear, steady_pressure, uniform_track
from thermowear.laws.formulas import FormulaWear, PlainFunction, wear_rate
from thermowear.laws.interfaces import WEAR_VARIABLES, LocalState, registered_laws

N = 40
RADIUS = np.linspace(0.02, 0.12, N)
AREAS = 2 * np.pi * RADIUS * np.gradient(RADIUS)
SPEED = 10.0 * RADIUS
FORCE = 5e7 * AREAS.sum()
ONE = np.ones((N, 1))
ROCKING = np.column_stack([np.ones(N), RADIUS - RADIUS.mean()])


def steady(laws, modes=ONE, load=(FORCE,), **more):
    return steady_pressure(
        AREAS, modes, more.pop("forces", modes), np.array(load), laws, SPEED, **more
    )


@pytest.mark.parametrize("exponents", [(1.0, 1.0), (0.6, 2.0), (3.0, 0.5)])
@pytest.mark.parametrize(
    "spread", [[InPlace(), InPlace()], [InPlace(), uniform_track(np.full(N, 1e-3))]]
)
@pytest.mark.parametrize("modes", [ONE, ROCKING])
def test_powers_as_functions_lead_to_the_closed_form(exponents, spread, modes):
    """requirement: any law by the interface alone; friction in equilibrium, tracks, tilting."""
    laws = [
        PowerWear(1e-13 * 1e6 ** (1 - b), b, a) for b, a in zip(exponents, (1.0, 0.7), strict=True)
    ]
    plain = [_plain(law) for law in laws]
    load = (FORCE,) if modes is ONE else (FORCE, 0.02 * FORCE)
    given = {"modes": modes, "load": load, "spread": spread, "forces": modes * 1.05}
    found, due = steady(plain, **given), steady(laws, **given)
    np.testing.assert_allclose(found.pressure, due.pressure, rtol=1e-8)
    np.testing.assert_allclose(found.velocity, due.velocity, rtol=1e-8)


def _plain(law):
    κ, b, a = law.coefficient, law.pressure_exponent, law.velocity_exponent
    return wear_rate(lambda p, v: κ * p**b * v**a)


def test_an_energy_law_with_a_threshold():
    """requirement: α (mu p v - q) uniform: ``p = (V/α + q)/(mu v)``, V from the load, by hand."""
    α, q, mu = 2e-13, 1e6, 0.25
    found = steady([registered_laws("wear")["energy"](α, q)], friction=np.full(N, mu))
    shape = 1 / (mu * SPEED)
    V = α * (FORCE / (AREAS @ shape) - q)
    np.testing.assert_allclose(found.pressure, (V / α + q) * shape, rtol=1e-9)
    assert found.velocity[0] == pytest.approx(V, rel=1e-9, abs=0.0)
    assert found.rates[0] == pytest.approx(V, rel=1e-9, abs=0.0)


def test_rates_that_depend_on_the_temperature():
    """requirement: ``κ p v exp(-T/T0)`` with given temperatures, by hand."""
    T = np.linspace(300, 500, N)[None]
    found = steady([wear_rate(lambda p, v, T: 1e-13 * p * v * np.exp(-T / 200))], temperature=T)
    shape = np.exp(T[0] / 200) / SPEED
    np.testing.assert_allclose(found.pressure, FORCE * shape / (AREAS @ shape), rtol=1e-9)


def test_nothing_wears_at_the_mean_pressure():
    """requirement: a threshold above the mean pressure is answered in words."""
    law = registered_laws("wear")["energy"](2e-13, 1e9)
    with pytest.raises(ComputationError, match="the wear rate at the mean pressure is 0"):
        steady([law], friction=np.full(N, 0.25))


def test_a_rate_that_falls_is_refused():
    """requirement: the principle needs rates that grow with the pressure."""
    falling = PlainFunction.of(lambda p, v: 1e-13 * p * v / (1 + (p / 2e7) ** 3), WEAR_VARIABLES)
    with pytest.raises(ComputationError, match="no steady"):
        steady([FormulaWear(falling)])


def test_a_class_derived_from_the_power_is_asked():
    """requirement: a rate of its own is not taken for the power."""

    class Offset(PowerWear):
        def value(self, at):
            return 1e-13 * at.p * np.sqrt(at.v)

        def slope(self, at):
            return np.full(len(at.p), 1e-13) * np.sqrt(at.v)

    shape = 1 / np.sqrt(SPEED)
    found = steady([Offset(5e-13, 1.0)])
    np.testing.assert_allclose(found.pressure, FORCE * shape / (AREAS @ shape), rtol=1e-9)


def pressure_at(rate, law):
    """Pressures at which a growing rate has given values, by bisection."""
    low, high = np.full(N, 1.0), np.full(N, 1e10)
    for _ in range(70):
        middle = np.sqrt(low * high)
        below = law.value(LocalState(middle, SPEED)) < rate
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.sqrt(low * high)


@settings(max_examples=15, deadline=None)
@given(
    b=st.floats(0.4, 2.5),
    a=st.floats(0.0, 1.5),
    step=st.floats(0.0, 5.0),
    at=st.floats(1e7, 2e8),
    steep=st.floats(0.0, 3.0),
    threshold=st.floats(0.0, 3e7),
)
def test_any_growing_rate_against_bisection(b, a, step, at, steep, threshold):
    """requirement: thresholds, jumps of slope and exponential growth; reference: bisection."""

    def rate(p, v):
        above = np.maximum(p - threshold, 0.0)
        power = (above / 5e7) ** b * v**a * (1 + step * np.tanh(p / at) ** 4)
        return 1e-6 * (power + 0.1 * steep * np.expm1(np.minimum(above / 1e8, 50.0)))

    law = wear_rate(rate)

    def excess(logarithm):
        return AREAS @ pressure_at(np.exp(logarithm), law) - FORCE

    V = np.exp(brentq(excess, np.log(1e-15), 0.0, xtol=1e-12))
    found = steady([law])
    assert found.velocity[0] == pytest.approx(V, rel=1e-7, abs=0.0)
    np.testing.assert_allclose(found.pressure, pressure_at(V, law), rtol=1e-6)
