"""The beam over a gap, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from thermowear.reference.beam import EXAMPLE

FLEXIBLE = replace(EXAMPLE, shear_stiffness=1.7e7)
BEAMS = pytest.mark.parametrize("beam", [EXAMPLE, FLEXIBLE])


def propped(beam, place, x):
    """Deflection at x of a cantilever propped at its end under a force, by the force method."""
    EI, GA, L = beam.bending_stiffness, beam.shear_stiffness or np.inf, beam.length

    def cantilever(a, x):
        a, x = max(a, x), min(a, x)
        return x**2 * (3 * a - x) / (6 * EI) + x / GA

    prop = cantilever(place, L) / cantilever(L, L)
    return beam.force * (cantilever(place, x) - prop * cantilever(L, x))


def test_deflection_under_the_load():
    """requirement: 7 F L³/(768 E I), 0.9 mm."""
    exact = 7 * EXAMPLE.force * EXAMPLE.length**3 / (768 * EXAMPLE.bending_stiffness)
    assert exact == pytest.approx(0.9e-3, rel=1e-12)
    assert np.interp(0.15, EXAMPLE.x, EXAMPLE.free_deflection) == pytest.approx(exact, rel=1e-7)


@BEAMS
@pytest.mark.parametrize("place", [0.06, 0.15, 0.2355])
def test_free_deflection(beam, place):
    """requirement: exact at the nodes, shear included, wherever the load is."""
    moved = replace(beam, load_position=place)
    exact = [propped(moved, place, x) for x in moved.x]
    np.testing.assert_allclose(moved.free_deflection, exact, rtol=1e-6)


@BEAMS
def test_contact_conditions(beam):
    """requirement: springs that press are closed by their pressure, the others open."""
    pressure = beam.contact(np.zeros_like(beam.x))
    deflection = beam.free_deflection - beam.area * beam.flexibility @ pressure
    opening = beam.gap + beam.compliance * pressure - deflection
    assert pressure.min() == 0.0
    assert pressure.max() > 0.0
    np.testing.assert_allclose(opening[pressure > 0], 0.0, atol=1e-15)
    assert opening[pressure == 0].min() > 0.0


@BEAMS
def test_it_shakes_down(beam):
    """requirement: in the end max(0, u_free - gap), and nothing presses, however fast it wears."""
    for rate in (EXAMPLE.rate, 20 * EXAMPLE.rate):
        worn = replace(beam, rate=rate)
        end = worn.states([100.0])[-1]
        np.testing.assert_allclose(end.worn, beam.shakedown, atol=1e-6 * beam.shakedown.max())
        assert end.pressure.max() < 10.0


def test_pressure_dies_out_exponentially():
    """requirement: while the same nodes touch, dp/dt = -κ (A + c)^-1 p, solved exactly."""
    early, late = EXAMPLE.states([12.0, 60.0])
    touching = early.pressure > 0
    assert np.array_equal(late.pressure > 0, touching)
    soft = EXAMPLE.area * EXAMPLE.flexibility + EXAMPLE.compliance * np.eye(len(EXAMPLE.x))
    decay = np.linalg.inv(soft[np.ix_(touching, touching)])
    exact = expm(-48.0 * EXAMPLE.rate * decay) @ early.pressure[touching]
    np.testing.assert_allclose(late.pressure[touching], exact, rtol=3e-3, atol=1e-3 * exact.max())


def test_time_steps_are_of_second_order():
    """requirement: the error of the last pressure falls with the square of the steps."""
    beam = replace(EXAMPLE, elements=60)
    found = [beam.states([12.0, 60.0], n)[-1].pressure.max() for n in (200, 400, 800, 3200)]
    errors = np.abs(np.array(found[:3]) / found[3] - 1)
    assert errors[1] < 2.5e-3
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), 2.0, atol=0.4)


def test_worn_depth_is_what_has_pressed():
    """requirement: w = κ ∫ p dt at the nodes that touch all the time."""
    times = np.linspace(2.0, 12.0, 401)
    states = EXAMPLE.states(list(times))
    pressed = np.trapezoid([s.pressure for s in states], times, axis=0)
    worn, touching = states[-1].worn - states[0].worn, states[0].pressure > 0
    np.testing.assert_allclose(worn[touching], EXAMPLE.rate * pressed[touching], rtol=5e-4)
