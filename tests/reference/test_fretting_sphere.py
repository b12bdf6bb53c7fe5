"""Fretting sphere by dimensionality reduction, against closed forms of its beginning and end."""

import numpy as np
import pytest

from thermowear.reference.elastic_contact.fretting_sphere import (
    EndOfFretting,
    FrettingSphere,
    end_at_approach,
    end_at_force,
)
from thermowear.reference.elastic_contact.mindlin_sphere import MindlinSphere

STEEL = (2e11, 0.3)
K = 2e-13
SMALL = MindlinSphere(20.0, 0.01, (STEEL, STEEL), 0.6)
LARGE = MindlinSphere(100.0, 0.01, (STEEL, STEEL), 0.6)
START = FrettingSphere(SMALL, 0.341995e-6, K, points=150)
CYCLES = (1, 1700, 9576, 40000)


def volume(end, r):
    return np.trapezoid(2 * np.pi * r * end.depth(r), r)


def test_unworn_is_cattaneos():
    """requirement: Hertz's pressure, stick radius and slip of Cattaneo and Mindlin."""
    now, r = START.contact(np.zeros_like(START.radius)), START.radius
    a = SMALL.contact_radius
    force = SMALL.limit * (1 - (now.stick_radius / a) ** 3)
    assert SMALL.displacement(force) == pytest.approx(START.amplitude, rel=1e-3)
    assert now.approach == pytest.approx(a**2 / SMALL.radius, rel=1e-4)
    inside = (r > 0.1 * a) & (r < 0.95 * a)
    pressure = SMALL.peak * np.sqrt(1 - (r[inside] / a) ** 2)
    np.testing.assert_allclose(now.pressure[inside], pressure, rtol=2e-2)
    slip = SMALL.slip(r[inside], force)
    np.testing.assert_allclose(now.slip[inside], slip, atol=1e-2 * START.amplitude)


@pytest.mark.parametrize(
    ("amplitude", "stick", "force", "pressures", "worn", "deepest"),
    [
        (0.5e-6, 0.899592, 0.985383, (1334.4, 1196.3), 2.18608e-15, 0.0967),
        (1.0e-6, 0.786467, 0.936474, (1365.5, 1275.4), 1.363824e-14, 0.2987),
    ],
)
def test_end_at_a_held_approach(amplitude, stick, force, pressures, worn, deepest):
    """requirement: the state without wear; its force is that of the pressure."""
    end = end_at_approach(FrettingSphere(LARGE, amplitude, K))
    a, c = LARGE.contact_radius, end.stick_radius
    r = np.linspace(0.0, 1.2 * a, 20001)
    assert c / a == pytest.approx(stick, rel=1e-5)
    assert end.force / LARGE.force == pytest.approx(force, rel=1e-5)
    assert end.pressure(np.array([0.0, c / 2])) / 1e6 == pytest.approx(pressures, rel=1e-4)
    assert volume(end, r) == pytest.approx(worn, rel=1e-4, abs=0.0)
    assert end.depth(r).max() * 1e6 == pytest.approx(deepest, rel=1e-3)
    angle = np.linspace(0.0, np.pi / 2, 2001)[:-1]  # r = c sin: no singularity
    ring = end.pressure(c * np.sin(angle)) * 2 * np.pi * c**2 * np.sin(angle) * np.cos(angle)
    assert np.trapezoid(ring, angle) == pytest.approx(end.force, rel=2e-3)


def test_march_from_cattaneo_to_the_end():
    """requirement: volume of the first cycle by its energy; at last the state without wear."""
    depths, a = START.depths(CYCLES), SMALL.contact_radius
    volumes, last = START.volume(depths), START.contact(depths[-1])
    force = SMALL.limit * (1 - (START.contact(depths[0]).stick_radius / a) ** 3)
    energy = SMALL.loss_per_cycle(force)
    assert volumes[0] == pytest.approx(K / SMALL.friction * energy, rel=1e-2, abs=0.0)
    c = last.stick_radius
    approach = SMALL.force / (2 * START.modulus * c) + c**2 / (3 * SMALL.radius)
    end = EndOfFretting(START, c, approach)
    known = volume(end, np.linspace(0.0, 1.2 * a, 20001))
    assert 0.94 * known < volumes[-1] < known
    assert last.approach == pytest.approx(approach, rel=2e-3)
    virgin, highest = START.contact(0 * depths[0]).stick_radius, end_at_force(START).stick_radius
    assert virgin * 0.998 < c < highest
    assert c / a == pytest.approx(0.792, rel=1e-2)
    assert volumes[1:] == pytest.approx([1.960e-16, 1.127e-15, 1.997e-15], rel=5e-2, abs=0.0)
