"""Closed forms of a coated bush."""

import numpy as np
import pytest

from thermowear.reference.coatings import CoatedBush

BUSH = CoatedBush(10e-3, 20e-3, 60e-6, 10e-6, 1e-15, 1e-14, 500.0, 0.1)


@pytest.mark.parametrize("depth", [4e-6, 10e-6, 25e-6])
def test_volumes_are_those_of_the_moved_circle(depth):
    """requirement: sums of the worn depth over the angle, below and above the coating."""
    θ = (np.arange(200000) + 0.5) / 200000 * np.pi / 2
    worn = np.maximum((60e-6 + depth) * np.cos(θ) - 60e-6, 0.0)
    area = 2 * 10e-3 * 20e-3 * (θ[1] - θ[0])
    below = np.maximum(worn - 10e-6, 0.0)
    coating, substrate = BUSH.volumes(BUSH.distance(depth))
    assert coating == pytest.approx(area * (worn - below).sum(), rel=1e-6, abs=0.0)
    assert substrate == pytest.approx(area * below.sum(), rel=1e-6, abs=1e-18)


@pytest.mark.parametrize("depth", [4e-6, 25e-6])
def test_the_pressure_of_the_rates_carries_the_force(depth):
    """requirement: p = d' cos θ/(k v), turned by friction: its resultant is F."""
    step, θ = 1e-10, (np.arange(200000) + 0.5) / 200000 * np.pi - np.pi / 2
    worn = (60e-6 + depth) * np.cos(θ) - 60e-6
    k = np.where(worn > 10e-6, 1e-14, 1e-15)
    per_distance = 2 * step / (BUSH.distance(depth + step) - BUSH.distance(depth - step))
    pressure = np.where(worn > 0.0, per_distance * np.cos(θ) / k, 0.0)
    along = pressure @ np.cos(θ) * 10e-3 * 20e-3 * (θ[1] - θ[0])
    assert np.hypot(along, 0.1 * along) == pytest.approx(500.0, rel=1e-4)


def test_a_narrow_contact_has_archards_volumes():
    """requirement: V_c/k_c + V_s/k_s = F s; the depth at a distance is that of the distance."""
    narrow = CoatedBush(10e-3, 20e-3, 5e-3, 1e-6, 1e-15, 1e-14, 500.0)
    distance = 3 * narrow.begin
    coating, substrate = narrow.volumes(distance)
    assert substrate > coating / 10
    assert coating / 1e-15 + substrate / 1e-14 == pytest.approx(500.0 * distance, rel=2e-3)
    assert narrow.distance(narrow.depth(distance)) == pytest.approx(distance, rel=1e-9)
    assert narrow.depth(narrow.begin) == pytest.approx(1e-6, rel=1e-9, abs=0.0)
