"""Contact at each point of the faces: a sphere in space, and a soft layer."""

from functools import cache

import numpy as np
import pytest

from thermowear.contact.wear.implicit_step import Slope
from thermowear.errors import CaseError
from thermowear.reference.elastic_contact.hertz import elliptical_contact
from thermowear.simulation.interface.interface_problem import interface_problem
from thermowear.simulation.system.conditions import ConditionModel
from thermowear.verification.cases.contact.hertz import MODULUS
from thermowear.verification.cases.contact.hertz_in_space import BALL, BLOCK, COARSE, FORCE, pressed
from thermowear.verification.check import run_starter, starter
from thermowear.verification.quarter_meshes import sphere_on_block

from ..systems import built

EXACT = elliptical_contact(FORCE, (BALL * 1e-3, BALL * 1e-3), MODULUS)


@cache
def solved(method):
    return pressed(sphere_on_block(BALL, BLOCK), EXACT, COARSE, method=method)


def error(interface):
    """Error of the pressure on the face in L², relative."""
    square = (interface.x**2 + interface.y**2) / EXACT.half_axes[0] ** 2
    exact = EXACT.peak * np.sqrt(np.maximum(1 - square, 0.0))
    missed = interface.pressure - exact
    return np.sqrt((interface.weight @ missed**2) / (interface.weight @ exact**2))


def test_edges_of_the_contact_within_elements():
    """
    requirement: with ten elements across the contact, the pressure at the points within 2.5 % in L²
    and at most half as far from Hertz as weak contact; no tension; the given force.
    """
    resolved, weak = (solved(method).interface for method in ("pointwise", "condensed"))
    assert error(resolved) < 0.025
    assert error(resolved) < 0.5 * error(weak)
    assert resolved.pressure.min() >= 0.0
    assert 4 * resolved.weight @ resolved.pressure == pytest.approx(FORCE, rel=1e-4)


def test_peak_and_approach():
    """requirement: peak within 0.2 % of Hertz, approach within 3e-4 of weak contact."""
    resolved, weak = (solved(method).summary for method in ("pointwise", "condensed"))
    assert resolved["max_pressure_Pa"] == pytest.approx(EXACT.peak, rel=2e-3)
    assert resolved["approach_m"] == pytest.approx(weak["approach_m"], rel=3e-4, abs=0.0)
    assert resolved["equilibrium_relative_error"] < 1e-9


def test_a_soft_layer_is_compressed_at_each_point():
    """requirement: a layer opens the gap of rigid bodies by its compliance times the pressure."""
    stiff = "bodies.cylinder.young_modulus=2e16 Pa"  # and that of the block
    layer = "contact.compliance=1e-13 m/Pa", "load={approach='5 um'}", "contact.positioning=false"
    found = run_starter(
        "cylinder-on-block", stiff, *layer, "contact.method=pointwise", "mesh.degree=2"
    )
    i = found.interface
    pressing = i.pressure > 0.01 * i.pressure.max()
    parabola = 5e-6 - i.x**2 / (2 * 10e-3)
    assert i.pressure[pressing] * 1e-13 == pytest.approx(parabola[pressing], abs=2e-8)


def test_the_size_of_the_bodies_does_not_matter():
    """requirement: lengths a thousand times, the force a million times: the same pressure."""
    coarse = "contact.method=pointwise", "mesh.degree=2", "contact.positioning=false"
    sizes = ("radius", 10), ("block_radius", 20), ("block_height", 20)
    large = [f"geometry.{key}={value} m" for key, value in sizes]
    one = run_starter("sphere-on-block", *coarse)
    other = run_starter("sphere-on-block", *coarse, *large, "load.force=500 MN")
    np.testing.assert_allclose(other.interface.x, 1e3 * one.interface.x, rtol=1e-12)
    scale = one.interface.pressure.max()
    assert np.abs(other.interface.pressure - one.interface.pressure).max() < 1e-8 * scale


def test_wear_is_refused():
    """requirement: an implicit step of wear, as of a model in Python, is an error."""
    system = built(starter("sphere-on-block", "contact.method=pointwise", "mesh.degree=2"))
    none = np.zeros(len(system.weights))
    conditions = ConditionModel(system).at(0.0, none, None, none == 0.0)
    method = interface_problem(system)._method
    arguments = system.pairing.gap, Slope.diagonal(none + 1e-15), None, conditions, None
    with pytest.raises(CaseError, match="without wear"):
        method.solve(*arguments)
