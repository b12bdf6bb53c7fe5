"""Pressures on surfaces of bodies that are held by a holder, or by their supports."""

import math

import numpy as np
import pytest

import thermowear as tw

from ..case.starter import changed
from .space import PUNCH
from .test_shared_edges import RING

BLOCKS = {
    "model": "plane-strain",
    "geometry": {
        "type": "punch-on-strip",
        "width": "40 mm",
        "height": "20 mm",
        "strip_length": "40 mm",
        "strip_height": "10 mm",
        "thickness": "10 mm",
    },
    "mesh": {"degree": 3, "elements": 6},
    "bodies": {
        "punch": {"young_modulus": "2 GPa", "poisson_ratio": 0.0},
        "strip": {"like": "punch"},
    },
    "load": {"pressure": {"punch_top": "2 MPa"}},
    "contact": {},
    "analysis": {"type": "initial"},
}
"""Two columns of one width: without a Poisson ratio the stress is uniform."""

BACK = {"pad_back": "3 MPa"}


def run(tables, changes=None):
    return tw.run(tw.load(changed(tables, changes or {})))


@pytest.mark.parametrize("method", ["condensed", "penalty", "nitsche"])
def test_pressure_on_the_back_of_a_held_punch(method):
    """
    requirement: the patch test: the same pressure in the contact, all of it in equilibrium; the
    columns give way by p h/E.
    """
    result = run(BLOCKS, {"contact.method": method})
    np.testing.assert_allclose(result.interface.pressure, 2e6, rtol=1e-6)
    assert result.summary["normal_force_N"] == pytest.approx(800.0, rel=1e-7)
    assert result.summary["equilibrium_relative_error"] < 1e-9
    soft = 3e-3 if method == "penalty" else 1e-9  # the penalty's own compliance
    assert result.summary["approach_m"] == pytest.approx(2e6 * 0.03 / 2e9, rel=soft)


@pytest.mark.parametrize("given", [{"force": "1 kN"}, {"mean_pressure": "2.5 MPa"}])
def test_pressure_beside_another_load(given):
    """
    requirement: a pressure adds to the force of the holder.
    """
    (key, value), *_ = given.items()
    result = run(BLOCKS, {f"load.{key}": value})
    np.testing.assert_allclose(result.interface.pressure, 4.5e6, rtol=1e-6)


def test_pressure_on_a_body_of_given_approach():
    """
    requirement: the holder stays where it is and takes what the columns do not; a pressure on the
    back does not reach the contact.
    """
    result = run(BLOCKS, {"load.approach": "30 um"})
    np.testing.assert_allclose(result.interface.pressure, 2e6, rtol=1e-6)
    assert result.summary["equilibrium_relative_error"] < 1e-9


def test_pressure_on_a_side():
    """
    requirement: guides hold the force on the side; a holder that may turn passes its moment on to
    the contact: 1 MPa on 20 mm x 10 mm, 10 mm above it.
    """
    side = {"load": {"force": "1 kN", "pressure": {"punch_left": "1 MPa"}}}
    result = run(BLOCKS, side | {"holder.free": ["z", "rotation"]})
    i, summary = result.interface, result.summary
    assert summary["guide_force_N"] == pytest.approx(-200.0, rel=1e-9)
    assert summary["equilibrium_relative_error"] < 1e-9
    w = i.weight
    assert w @ i.pressure == pytest.approx(1000.0, rel=1e-9)
    assert w @ (i.pressure * i.x) == pytest.approx(200.0 * 0.01, rel=1e-9)
    held = run(BLOCKS, side)
    moment = held.interface.weight @ (held.interface.pressure * held.interface.x)
    assert held.summary["guide_moment_Nm"] == pytest.approx(2.0 - moment, rel=1e-9)


def test_pressure_on_the_body_below():
    """
    requirement: its support takes it: 1 MPa on a side of the strip, whose columns are squeezed
    sideways and, with a Poisson ratio, upwards: the same force, in another distribution.
    """
    load = {"load": {"force": "1 kN", "pressure": {"strip_left": "1 MPa", "strip_right": "1 MPa"}}}
    poisson = {"bodies.punch.poisson_ratio": 0.3}
    squeezed, plain = (run(BLOCKS, poisson | given) for given in (load, {"load.force": "1 kN"}))
    assert squeezed.summary["equilibrium_relative_error"] < 1e-9
    assert squeezed.summary["normal_force_N"] == pytest.approx(1000.0, rel=1e-9)
    i = squeezed.interface
    np.testing.assert_allclose(i.pressure, i.pressure[::-1], rtol=1e-6)
    assert np.abs(i.pressure / plain.interface.pressure - 1).max() > 0.05


@pytest.mark.parametrize("analysis", ["steady", "transient"])
def test_pressure_on_the_back_wears_as_the_force_does(analysis):
    """
    requirement: 3 MPa on the back of a pad are 3 MPa times its area: the same worn state, and a
    holder that is fixed or moves makes the same equilibrium.
    """
    settings = {"type": analysis} | ({} if analysis == "steady" else {"end_time": "100 s"})
    case = changed(RING, {"analysis": settings, "mesh": {"degree": 3, "elements": 6}})
    area = math.pi / 6 * (0.12**2 - 0.08**2)
    by_force = run(case, {"load": {"force": f"{3e6 * area!r} N"}})
    by_pressure = run(case, {"load": {"pressure": BACK}})
    for name in ("pressure", "shape", "wear_1", "wear_2"):
        expected = getattr(by_force.interface, name)
        found = getattr(by_pressure.interface, name)
        size = np.abs(expected).max()
        np.testing.assert_allclose(found, expected, atol=1e-6 * size, rtol=0, err_msg=name)
    assert by_pressure.summary["equilibrium_relative_error"] < 1e-9


def test_pressure_stays_when_the_force_goes():
    """
    requirement: a history is of the force alone; the pressure is constant beside it.
    """
    history = {"time": ["0 s", "10 s"], "force": ["10 kN", "0 N"]}
    case = changed(RING, {"mesh": {"degree": 2, "elements": 4}, "load": {"pressure": BACK}})
    result = run(
        case, {"load.history": history, "analysis": {"type": "transient", "end_time": "10 s"}}
    )
    area = math.pi / 6 * (0.12**2 - 0.08**2)
    assert result.summary["normal_force_N"] == pytest.approx(3e6 * area, rel=1e-9)
    before = 1 + 1e4 / (3e6 * area)  # the same shape of the pressure, nearly unworn
    found = result.history[0].max_pressure / result.history[-1].max_pressure
    assert found == pytest.approx(before, rel=0.02)
    assert result.summary["equilibrium_relative_error"] < 1e-9


def test_pressure_in_space():
    """
    requirement: on the back of a punch that may tilt it adds to the force, in its own middle:
    10 kN at -5 mm and 4.8 kN at 0. On the sides all round it presses nothing.
    """
    case = {"load.pressure": {"punch_top": "1 MPa", "punch_sides": "3 MPa"}}
    changes = {"mesh": {"degree": 2, "elements": 2}, "contact.friction": 0.0}
    law = {"wear.punch": {"coefficient": "1e-7 1/MPa", "per": "pressure"}}
    result = run(PUNCH, case | changes | law)
    i = result.interface
    assert result.summary["equilibrium_relative_error"] < 1e-9
    assert result.summary["normal_force_N"] == pytest.approx(14.8e3, rel=1e-9)
    assert i.weight @ (i.pressure * i.x) == pytest.approx(-5e-3 * 1e4, rel=1e-9)


def test_pressure_while_sliding_to_and_fro():
    """
    requirement: every position of the stroke is in equilibrium with the pressure on the back.
    """
    slides = {
        "geometry.strip_length": "60 mm",
        "geometry.stroke": "5 mm",
        "mesh": {"degree": 2, "elements": 6, "grading": 1.0},
        "motion": {"amplitude": "5 mm", "frequency": "1 Hz"},
        "contact.friction": 0.1,
        "wear": {"punch": {"coefficient": "1e-8 1/MPa"}},
        "analysis": {"type": "reciprocating", "cycles": 3, "positions": 2},
    }
    by_force = run(BLOCKS, slides | {"load": {"force": "800 N"}})
    by_pressure = run(BLOCKS, slides)
    expected = by_force.interface.wear_1
    np.testing.assert_allclose(
        by_pressure.interface.wear_1, expected, atol=1e-7 * expected.max(), rtol=0
    )
    assert by_pressure.summary["equilibrium_relative_error"] < 1e-9


def test_error_estimate_under_a_pressure():
    """requirement: the estimate of a steady state is of the same loads: that of a force alike."""
    steady = {
        "motion": {"velocity": "1 m/s"},
        "wear": {"punch": {"coefficient": "1e-8 1/MPa"}},
        "analysis": {"type": "steady"},
        "contact": {"friction": 0.1},
    }
    pressed, held = run(BLOCKS, steady), run(BLOCKS, steady | {"load": {"mean_pressure": "2 MPa"}})
    for key in ("pressure_error_estimate_relative", "shape_error_estimate_relative"):
        expected = held.summary[key]
        assert pressed.summary[key] == pytest.approx(expected, rel=1e-6, abs=1e-12)
