"""An elastic sphere of finite size on a half-space tends to Hertz's contact."""

from __future__ import annotations

import numpy as np
import pytest

from thermowear.reference.elastic_contact.hertz import (
    contact_modulus,
    normal_compliance,
    point_contact,
    sphere_on_half_space,
)

STEEL = (210e9, 0.3)
RADIUS = 10e-3


def peak_ratio(force: float) -> float:
    """Peak pressure over Hertz's."""
    flat = point_contact(force, RADIUS, contact_modulus(STEEL, STEEL))
    return sphere_on_half_space(force, RADIUS, STEEL, STEEL).peak / flat.peak


def test_a_light_contact_is_hertz_and_the_first_difference_grows_with_its_radius():
    """requirement: the peak falls by about 0.02 a/R: eight times the force, twice the deviation."""
    light, heavy = (1.0 - peak_ratio(force) for force in (62.5, 500.0))
    assert light == pytest.approx(0.02 * 0.016, rel=0.1)
    assert heavy / light == pytest.approx(2.0, rel=0.05)


def test_the_peak_carries_the_force():
    """requirement: with a pressure close to an ellipse, a³ p0 follows from F = 2π a² p0/3."""
    found = sphere_on_half_space(500.0, RADIUS, STEEL, STEEL)
    assert 2 * np.pi * found.half_width**2 * found.peak / 3 == pytest.approx(500.0, rel=1e-3)


def test_uniform_pressure_compresses_a_sphere_by_its_bulk_modulus():
    """requirement: u = p R/(3 K), in units of R/(2G)."""
    (found,) = normal_compliance(np.array([0]), 0.3)
    bulk_over_shear = 2 * 1.3 / (3 * 0.4)
    assert found == pytest.approx(2 / (3 * bulk_over_shear))


def test_short_waves_see_a_half_space():
    """requirement: u/p tends to (1 - ν) R/(G n)."""
    (found,) = normal_compliance(np.array([10_000]), 0.3)
    assert found == pytest.approx(2 * 0.7 / 10_000, rel=1e-3)
