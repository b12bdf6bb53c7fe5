"""Continuation of contact from bodies without friction heat."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import thermowear as tw
from thermowear.contact.solvers.signorini import NoEquilibrium, solve_contact
from thermowear.simulation.interface.condensed_method import CondensedMethod

from ..case.starter import STEADY, tables

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


def hot_ring(method, speed="0.3 rad/s"):
    """Summary of an unworn ring that heat lifts off its plate but for its inner quarter."""
    case = tables(STEADY)
    case |= {"motion": {"angular_velocity": speed}, "analysis": {"type": "initial"}}
    case |= {"mesh": {"elements": 12, "grading": 0.3, "degree": 4}}
    case["contact"]["method"] = method
    return tw.run(tw.load(case)).summary


def test_contact_that_heat_makes_small():
    """requirement: beyond the critical speed of full contact the state is that of Nitsche's method,
    which iterates on heat and pressure without continuation.
    """
    condensed, nitsche = hot_ring("condensed"), hot_ring("nitsche")
    assert condensed["contact_area_m2"] < 0.2 * np.pi * (0.12**2 - 0.02**2)
    assert condensed["contact_area_m2"] == pytest.approx(nitsche["contact_area_m2"], rel=0.05)
    for key, relative in (("approach_m", 3e-3), ("friction_power_W", 5e-3)):
        assert condensed[key] == pytest.approx(nitsche[key], rel=relative)
    rise = [found["max_temperature_K"] - 293.15 for found in (condensed, nitsche)]
    assert rise[0] == pytest.approx(rise[1], rel=3e-3)
