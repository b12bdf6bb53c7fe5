"""Closed form of spheres under tangential force, against what it must balance."""

import numpy as np
import pytest

from thermowear.reference.elastic_contact.hertz import point_contact
from thermowear.reference.elastic_contact.mindlin_sphere import MindlinSphere

STEEL = (2e11, 0.3)
SPHERE = MindlinSphere(20.0, 0.01, (STEEL, (7e10, 0.33)), 0.6)
Q = 0.7 * SPHERE.limit
A = SPHERE.contact_radius


def over_contact(values, r):
    return np.trapezoid(2 * np.pi * r * values, r)


@pytest.fixture
def r():
    return np.linspace(0.0, A, 20001)


def test_shear_carries_the_force(r):
    """requirement: the shear integrates to Q, and to the friction limit for Q = mu P."""
    assert over_contact(SPHERE.shear(r, Q), r) == pytest.approx(Q, rel=1e-5)
    assert SPHERE.stick_radius(SPHERE.limit) == 0.0
    assert SPHERE.peak == pytest.approx(point_contact(20.0, 0.01, _modulus()).peak, rel=1e-12)


def _modulus():
    return 1 / sum((1 - nu**2) / E for E, nu in SPHERE.bodies)


def test_small_forces_meet_the_stiffness_of_a_stuck_circle():
    """requirement: dδ/dQ = S/(8a) without slip (Mindlin, J. Appl. Mech. 16 (1949) 259)."""
    soft = sum((2 - nu) * 2 * (1 + nu) / E for E, nu in SPHERE.bodies)
    slope = SPHERE.displacement(1e-6 * SPHERE.limit) / (1e-6 * SPHERE.limit)
    assert slope == pytest.approx(soft / (8 * A), rel=1e-6)


def test_energy_of_the_loop_and_of_the_slip(r):
    """requirement: area of the loop of force and displacement, and work of friction in the slip."""
    q = np.linspace(-Q, Q, 20001)
    back = np.array([SPHERE.displacement_after(Q, x) for x in q])
    loss = SPHERE.loss_per_cycle(Q)
    assert np.trapezoid(back + back[::-1], q) == pytest.approx(loss, rel=1e-6)
    limit = SPHERE.friction * SPHERE.peak * np.sqrt(np.maximum(1 - (r / A) ** 2, 0.0))
    assert 4 * over_contact(limit * SPHERE.slip(r, Q), r) == pytest.approx(loss, rel=1e-5)
    assert not SPHERE.slip(r[r < SPHERE.stick_radius(Q)], Q).any()


def test_torque_of_gross_twist(r):
    """requirement: ∫ mu p r dA."""
    limit = SPHERE.friction * SPHERE.peak * np.sqrt(np.maximum(1 - (r / A) ** 2, 0.0))
    assert over_contact(limit * r, r) == pytest.approx(SPHERE.twist_limit, rel=1e-5)


def test_small_twists_meet_the_stiffness_of_a_stuck_circle():
    """requirement: the shear ``4 G φ r/(π sqrt(a² - r²))`` of a stuck circle has the torque."""
    soft = sum(2 * (1 + nu) / E for E, nu in SPHERE.bodies)
    angle = np.linspace(0.0, np.pi / 2, 20001)  # r = a sin(angle)
    r = A * np.sin(angle)
    shear = 4 / np.pi * r / soft  # times sqrt(a² - r²), per twist of both bodies together
    torque = np.trapezoid(2 * np.pi * r**2 * shear, angle)
    assert 1 / torque == pytest.approx(SPHERE.twist_compliance, rel=1e-6)
