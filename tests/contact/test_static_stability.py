"""Static thermoelastic stability of a contact zone."""

from __future__ import annotations

import numpy as np
import pytest

from thermowear.contact.solvers.signorini import critical_factor

ALL = np.ones(3, dtype=bool)
PRESSED = np.ones((3, 1))


def is_stable(*state):
    return critical_factor(*state) >= 1.0


@pytest.mark.parametrize(("speed", "stable"), [(0.99, True), (1.01, False), (-5.0, True)])
def test_rods_that_share_a_load(speed, stable):
    """
    requirement: rods of compliance c beside each other under a rigid plate, each longer by h times
    its load: the load goes to one of them where h > c.
    """
    c, h = 2e-9 * np.eye(3), -2e-9 * np.eye(3)
    assert is_stable(c, speed * h, PRESSED, ALL) is stable


def test_factor():
    """requirement: the heat that makes the softest difference of loads neutral."""
    assert critical_factor(np.eye(3), -0.5 * np.eye(3), PRESSED, ALL) == pytest.approx(2.0)
    assert critical_factor(np.eye(3), 0.5 * np.eye(3), PRESSED, ALL) == np.inf


def test_only_the_contact_zone_counts():
    """requirement: open rods and the mean load, which the plate carries, make nothing unstable."""
    hot = -np.diag([3.0, 0.5, 0.5])
    assert not is_stable(np.eye(3), hot, PRESSED, ALL)
    assert is_stable(np.eye(3), hot, PRESSED, np.array([False, True, True]))
    assert is_stable(np.eye(3), hot, PRESSED, np.array([True, False, False]))  # no free pressure
    assert is_stable(np.eye(3), -5.0 * np.ones((3, 3)), PRESSED, ALL)  # alike for all rods


def test_modes_that_swing_are_not_static():
    """requirement: complex eigenvalues are left to the analysis of stability in time."""
    swinging = -2.0 * np.array([[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    assert is_stable(np.eye(3), swinging, np.zeros((3, 0)), ALL)
