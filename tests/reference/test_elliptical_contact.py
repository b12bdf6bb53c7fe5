"""Elliptical contact against its limits and a numerical integration of Boussinesq's solution."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from thermowear.reference.elastic_contact.hertz import (
    elliptical_contact,
    line_contact,
    point_contact,
)

MODULUS = 115e9


def test_circle():
    """requirement: equal radii give the contact of a sphere, with ``δ = a²/R``."""
    found = elliptical_contact(50.0, (8e-3, 8e-3), MODULUS)
    known = point_contact(50.0, 8e-3, MODULUS)
    assert found.half_axes == pytest.approx((known.half_width,) * 2, rel=1e-12, abs=0.0)
    assert found.peak == pytest.approx(known.peak, rel=1e-12)
    assert found.approach == pytest.approx(known.half_width**2 / 8e-3, rel=1e-12, abs=0.0)


def test_long_ellipse():
    """
    requirement: each section of a long contact is one of a cylinder under the load there,
    ``π b p0/2`` per length in the middle.
    """
    found = elliptical_contact(50.0, (100.0, 5e-3), MODULUS)
    a, b = found.half_axes
    section = line_contact(pi * b * found.peak / 2, 5e-3, MODULUS)
    assert a / b > 300
    assert section.half_width == pytest.approx(b, rel=1e-4, abs=0.0)
    assert section.peak == pytest.approx(found.peak, rel=1e-4)


@pytest.mark.parametrize("radii", [(10e-3, 25e-3), (25e-3, 10e-3), (2e-3, 60e-3)])
def test_closure(radii):
    """
    requirement: displacements ``∫ p/(π E* r) dA`` plus the gap equal the approach at points of the
    ellipse, and the pressure carries the force.

    Polar coordinates around each point cancel the singularity; the ellipsoidal pressure along a
    chord is a semicircle, whose integral over the chord is that of the peak along it times π/4.
    """
    found = elliptical_contact(50.0, radii, MODULUS)
    a, b = found.half_axes
    assert 2 * pi * a * b * found.peak / 3 == pytest.approx(50.0, rel=1e-12)
    angle = (np.arange(4000) + 0.5) * pi / 4000  # directions of whole chords
    for x, y in ((0.0, 0.0), (0.6 * a, 0.0), (0.0, 0.9 * b), (0.5 * a, 0.7 * b)):
        slope = (np.cos(angle) / a) ** 2 + (np.sin(angle) / b) ** 2
        middle = (x * np.cos(angle) / a**2 + y * np.sin(angle) / b**2) / slope
        left = 1 - (x / a) ** 2 - (y / b) ** 2 + middle**2 * slope  # highest (p/p0)² of the chord
        displacement = found.peak * pi / 2 * np.mean(left / np.sqrt(slope)) / MODULUS
        gap = x**2 / (2 * radii[0]) + y**2 / (2 * radii[1])
        assert displacement + gap == pytest.approx(found.approach, rel=1e-9, abs=0.0)


def test_exchanged_directions():
    """requirement: exchanging the directions exchanges the half-axes and nothing else."""
    one, two = (elliptical_contact(50.0, radii, MODULUS) for radii in ((1e-2, 3e-2), (3e-2, 1e-2)))
    assert one.half_axes == pytest.approx(two.half_axes[::-1], rel=1e-12, abs=0.0)
    assert (one.peak, one.approach) == pytest.approx((two.peak, two.approach), rel=1e-12, abs=0.0)
    a, b = one.half_axes
    x, y = np.array([0.0, 0.6 * a, 2 * a]), np.array([0.0, 0.0, b])
    assert one.pressure(x, y) == pytest.approx(one.peak * np.array([1.0, 0.8, 0.0]))


def test_mean_radius_approximation():
    """
    requirement: slightly elliptical contacts have about ``√(ab)`` and p0 of a sphere with the
    radius ``√(Rx Ry)`` (Johnson, section 4.2, equivalent radius).
    """
    found = elliptical_contact(50.0, (1e-2, 1.6e-2), MODULUS)
    sphere = point_contact(50.0, sqrt(1e-2 * 1.6e-2), MODULUS)
    assert sqrt(np.prod(found.half_axes)) == pytest.approx(sphere.half_width, rel=0.01, abs=0.0)
    assert found.peak == pytest.approx(sphere.peak, rel=0.01)
