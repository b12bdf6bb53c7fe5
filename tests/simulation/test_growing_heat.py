"""Continuation of contact from bodies without friction heat."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from thermowear.contact.solvers.signorini import NoEquilibrium, solve_contact
from thermowear.simulation.interface.condensed_method import CondensedMethod

PRESSED, LOAD = np.ones((3, 1)), np.array([3.0])
METHOD = SimpleNamespace(_contact=SimpleNamespace(modes=PRESSED))


def solved(compliance, opening, guess):
    """Contact of rods under a rigid plate, from the contact set of a guess."""
    start = None if guess is None else guess.warm_start.active
    return SimpleNamespace(warm_start=solve_contact(compliance, opening, PRESSED, LOAD, start))


def grown(heat):
    """Coefficients of three rods, each longer by `heat` times its load over its compliance."""
    thermal = -heat * np.eye(3)
    found = CondensedMethod._with_growing_heat(METHOD, solved, np.eye(3), thermal, np.zeros(3))
    return found.warm_start.coefficients


def test_equal_rods_share_the_load():
    """requirement: below the critical heat the rods press alike."""
    np.testing.assert_allclose(grown(0.9), 1.0, rtol=1e-12)


def test_a_state_that_perturbations_leave_is_refused():
    """requirement: above it equal pressures solve all equations, but are no answer."""
    with pytest.raises(NoEquilibrium, match="small perturbations"):
        grown(1.1)
