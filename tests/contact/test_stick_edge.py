"""Edge of the stick zone inside of coefficients."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from thermowear.contact.friction.frictional_contact import unloaded
from thermowear.contact.friction.stick_edge import (
    StickEdge,
    gap_beside,
    held_back,
    radius_of,
    stick_edge,
)
from thermowear.contact.friction.stick_slip import follow
from thermowear.contact.friction.stick_slip_state import Status
from thermowear.reference.elastic_contact.fretting_sphere import FrettingSphere
from thermowear.reference.elastic_contact.hertz import MindlinLine
from thermowear.reference.elastic_contact.mindlin_sphere import MindlinSphere

from .half_plane import half_plane, loaded

LINE = MindlinLine(force=1e5, radius=0.05, modulus=1e11, friction=0.4)
CELLS = 40


class Line:
    """Contact points on a line."""

    def __init__(self, x):
        self.points, self.weights = np.column_stack([x, 0 * x]), np.full(len(x), np.ptp(x[:2]))


def zone_of(push):
    """Stick zone of a cycle of a half-plane in cells, and its known half-width [m]."""
    x, contact = half_plane(LINE, CELLS)
    loads = [loaded(normal_force=LINE.force, tangential_force=q) for q in (0.0, push, -push, push)]
    states = list(follow(contact, LINE.friction, loads, 4))
    fine = np.linspace(2 * x[0] - x[1], 2 * x[-1] - x[-2], 20 * CELLS + 21)
    hats = np.array([np.interp(fine, x, one, 0.0, 0.0) for one in np.eye(CELLS)]).T
    along = np.tile([1.0, 0.0], (1, len(fine), 1))
    softness, friction = np.full(len(fine), 1 / LINE.modulus), np.full(CELLS, LINE.friction)
    edge = stick_edge(Line(fine), hats, along, softness, friction)
    return edge.zone(states[7:], True), edge, LINE.stick_half_width(push)


@pytest.mark.parametrize("part", np.linspace(0.3, 0.5, 6))
def test_the_edge_is_inside_of_a_cell(part):
    """requirement: half-width of Cattaneo and Mindlin to a seventh of a cell, wherever it lies."""
    zone, edge, known = zone_of(part * LINE.limit)
    width = np.ptp(edge.places[10:12, 0])
    assert abs(radius_of(zone.edge, False) - known) < width / 7
    assert zone.part @ np.full(CELLS, width) == pytest.approx(2 * known, abs=0.3 * width)
    assert set(zone.part[zone.part > 0.0].round(12)) - {1.0}
    np.testing.assert_allclose(zone.part, zone.part[::-1], atol=1e-6)


def test_rounding_decides_nothing():
    """requirement: of places on a grid, many of which are equally far, and an uneven pressure."""
    side, rng = np.linspace(-2.4, 2.4, 49), np.random.default_rng(5)
    grid = np.stack([*np.meshgrid(side, side), np.zeros((49, 49))], axis=2).reshape(-1, 3)
    line = sp.diags_array([0.25, 0.5, 0.25], offsets=[-1, 0, 1], shape=(49, 49))
    means, many, unit = sp.kron(line, line, format="csr"), len(grid), np.eye(3)[:2]
    axes, spread = np.repeat(unit[:, None], many, axis=1), np.tile(0.01 * np.eye(2), (many, 1, 1))
    radius = np.linalg.norm(grid, axis=1)
    pressure = np.sqrt(np.maximum(4.8 - radius**2, 0.0))
    unsheared = np.sqrt(np.maximum(2.8 - radius**2, 0.0)) * rng.uniform(0.9, 1.0, many)
    status = np.where(unsheared > 0.0, Status.STICK, Status.SLIP)
    pressed = unloaded(half_plane(LINE, CELLS)[1])
    none, shear = np.zeros(many), 0.4 * (pressure - unsheared)[:, None] * (1.0, 0.0)
    uneven = {"pressure": pressure, "shear": shear, "status": status}
    state = replace(pressed, **uneven, part=none, onset=none)
    zones = [
        StickEdge(places, axes, spread, means, none + 1.0, none + 0.4).zone([state], False)
        for places in (grid, *(grid + 1e-15 * rng.normal(size=(4, *grid.shape))))
    ]
    assert np.count_nonzero((zones[0].part > 0.0) & (zones[0].part < 1.0)) > 20
    for zone in zones:
        np.testing.assert_allclose(zone.part, zones[0].part, rtol=0.0, atol=1e-12)


def test_the_pressure_that_bears_no_shear():
    """requirement: at an instant what the shear leaves of the friction limit; in a cycle that of
    the shear that swings, whatever remains, by the mean pressure if that drifts.
    """
    _, edge, _ = zone_of(0.4 * LINE.limit)
    pressed = unloaded(half_plane(LINE, CELLS)[1])
    pressure, swing = np.full(CELLS, 3e6), np.full((CELLS, 1), 0.8e6)

    def state(factor, sign):
        return replace(pressed, pressure=factor * pressure, shear=0.1e6 + sign * swing)

    at_once = edge.zone([state(1.0, 1)], False).unsheared
    np.testing.assert_allclose(at_once, 3e6 - 0.9e6 / LINE.friction, rtol=1e-12)
    cycle = edge.zone([state(1.0, 1), state(1.1, -1)], True).unsheared
    np.testing.assert_allclose(cycle, 1.05 * 3e6 - 0.8e6 / LINE.friction, rtol=1e-12)


def test_the_opening_grows_as_less_sticks():
    """requirement: none at a whole coefficient, without bound at none, that of a punch between."""
    edge = zone_of(0.4 * LINE.limit)[1]
    part = np.linspace(1.0, 0.0, CELLS)
    found = edge.opening(part)
    assert np.isinf(found[[0, -1]]).all()  # wholly stuck or slipping, they wear as all others do
    assert np.all(np.diff(found[1:-1]) > 0.0)
    half = edge.opening(np.full(CELLS, 0.5))
    # beside a punch: mean opening by mean pressure of a cell half of which is under it
    np.testing.assert_allclose(half, np.sqrt(edge.spread[:, 0, 0]) / LINE.modulus, rtol=1e-12)


def test_a_punch_may_end_inside_of_a_cell():
    """requirement: with that opening as stiff as its closed form, wherever in a cell it ends.

    Half-planes; the displacement ``2 F/(πE*) ln(2 far/c)`` of a flat punch of the half-width c is
    counted from where that of a line load vanishes.
    """
    count, sub = 32, 20
    x = np.arange(count) - (count - 1) / 2
    fine = (np.arange((count + 1) * sub) + 0.5) / sub - (count + 1) / 2
    hats = np.maximum(1 - np.abs(fine[:, None] - x), 0.0)
    distance, far, step = np.subtract.outer(fine, fine), 4 * count, 1 / sub
    upper, lower = distance + step / 2, distance - step / 2
    line = upper * np.log(np.abs(upper) / far) - lower * np.log(np.abs(lower) / far) - step
    compliance = -2 / np.pi * step * hats.T @ line @ hats
    along, ones = np.tile([1.0, 0.0], (1, len(fine), 1)), np.ones(count)
    edge = stick_edge(Line(fine), hats, along, np.ones(len(fine)), ones)
    errors = []
    for half_width in np.linspace(9.0, 11.0, 21):
        part = np.clip(edge.sticking(half_width - np.abs(x), 1.0), 0.0, 1.0)
        under = np.flatnonzero(part > 0.0)
        opened = np.where(part < 1.0, edge.opening(part), 0.0)[under]
        stiffness = np.linalg.solve(compliance[np.ix_(under, under)] + np.diag(opened), ones[under])
        errors.append(2 * far * np.exp(-np.pi / (2 * stiffness.sum())) - half_width)
    assert np.abs(errors).max() < 0.02
    assert np.std(errors) < 0.005


@pytest.mark.parametrize("beyond", [-0.3, 0.0, 0.3])
def test_wear_holds_the_edge_back(beyond):
    """requirement: a sphere's edge moves outwards as in a march by dimensionality reduction."""
    steel = 2e11, 0.3
    sphere = FrettingSphere(MindlinSphere(20.0, 0.01, (steel, steel), 0.6), 0.342e-6, 2e-13, 400)
    first, *later = sphere.depths((1, 1700, 4647))
    edge = sphere.contact(first).stick_radius
    rise, width = 2 * sphere.modulus / (np.pi * 0.01) * np.sqrt(2 * edge), 0.05 * edge
    place = edge - beyond * width
    near = np.linspace(place - width, place + width, 2001)
    hat = 1 - np.abs(near - place) / width
    for depths in later:
        state = sphere.contact(depths)
        unheld = np.sqrt(0.01 * (state.approach - sphere.lift))
        worn = np.trapezoid(np.interp(near, sphere.radius, depths) * hat, near) / width
        ratio = worn / gap_beside(beyond, width, rise / sphere.modulus)
        found = edge + held_back(unheld - edge, ratio)
        assert found - edge == pytest.approx(state.stick_radius - edge, rel=0.1)


@pytest.mark.parametrize("to", [np.pi, 2 * np.pi])
def test_radii(to):
    """requirement: of circles and of their arcs, as on half a body; half-widths; from an axis."""
    angles = np.linspace(0.2, to, 9)
    circle = np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    turned = circle @ np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    assert radius_of(3.0 * turned + 7.0, False) == pytest.approx(3.0, rel=1e-9)
    assert radius_of(np.array([[1.0, 1.0], [4.0, 5.0]]), False) == pytest.approx(2.5)
    assert radius_of(np.array([[2.0, 1.0]]), True) == 2.0
    assert np.isnan(radius_of(np.zeros((0, 3)), False))
    assert np.isnan(radius_of(np.zeros((0, 2)), True))
