"""Heat at the interface, on two blocks in which it flows straight down."""

from math import inf

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.heat.heat_equation import ThermalMaterial, conduction
from thermowear.bulk.kinematics import Axisymmetric
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.contact.faces.face import gather_face
from thermowear.contact.operators.condensation import (
    bath_matrix,
    condense_heat,
    gap_trace,
    influence,
    pressure_loads,
    value_trace,
)
from thermowear.contact.operators.heat_exchange import FaceHeat, baseline_response
from thermowear.contact.operators.pressure import pressure_basis
from thermowear.contact.operators.rigid_motion import RigidMode, hold
from thermowear.contact.operators.thermal_opening import ThermalOpening, condense_distortion
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.laws.motions import translation
from thermowear.parallel import sum_over_ranks
from thermowear.reference.heat import contact_temperatures

from ..conftest import two_blocks

COMM = MPI.COMM_WORLD
MATERIALS = {"upper": ThermalMaterial(50.0), "lower": ThermalMaterial(15.0)}


def interface(degree, columns, partition=0.5, given=None, cooling=None):
    tagged = two_blocks(heights=(0.01, 0.02), columns=columns) if COMM.rank == 0 else None
    bodies = distribute(tagged, COMM)
    pairing = pair(
        gather_face(bodies, "upper_face"),
        gather_face(bodies, "lower_face"),
        Axisymmetric(),
        degree + 2,
    )
    spaces = lagrange_spaces(bodies, degree)
    traces = tuple(value_trace(spaces, side) for side in pairing.sides)
    shifts = tuple(np.full(len(pairing.weights), shift) for shift in (1000.0, 300.0))
    bath = bath_matrix(spaces, traces, pairing.weights, shifts)
    given = {"upper_end": 0.0, "lower_end": 0.0} if given is None else given
    conducting = conduction(bodies, Axisymmetric(), spaces, MATERIALS, cooling or {}, given, bath)
    basis = pressure_basis(pairing, max(degree - 1, 1))
    layers = tuple(shift * basis.shape[1] for shift in shifts)
    at_points = pairing.weights, basis, traces, shifts, layers, partition
    face = condense_heat(conducting, FaceHeat(*at_points))
    still = conducting.solve(np.zeros(len(conducting.fixed)))
    return bodies, pairing, conducting, basis, face, baseline_response(still, traces, COMM)


def everywhere(pairing, conductance):
    return np.full(len(pairing.weights), conductance)


@pytest.mark.parametrize("columns", [(3, 3), (3, 4)])
@pytest.mark.parametrize("h", [0.0, 1e3, 1e4, inf])
@pytest.mark.parametrize("f", [0.5, 0.2])
def test_two_slabs(h, f, columns):
    """requirement: temperatures and fluxes of two slabs with friction heat between them, to 1e-9.

    The published figures (q = 1e5 W/m²): h = 1e3 gives 14.47368 and 36.84211 K, q1 = 72368.42.
    """
    _, pairing, _, _, face, resting = interface(3, columns, f)
    made = np.full(len(pairing.weights), 1e5)
    state = face.exchange(everywhere(pairing, h)).state(made, resting)
    rises, fluxes = contact_temperatures((0.01, 0.02), (50.0, 15.0), (0, 0), 1e5, f, h)
    for found, exact in zip((*state.rise, *state.flux), (*rises, *fluxes), strict=True):
        np.testing.assert_allclose(found, exact, rtol=1e-9, atol=1e-6)
    if (h, f) == (1e3, 0.5):
        assert (*rises, fluxes[0]) == pytest.approx((14.47368, 36.84211, 72368.42), rel=1e-6)


def test_given_end_temperatures():
    """requirement: heat crosses the contact from the hot end to the cold one."""
    given = {"upper_end": 100.0, "lower_end": 20.0}
    _, pairing, conducting, _, face, resting = interface(2, (3, 2), given=given)
    state = face.exchange(everywhere(pairing, 5e3)).state(np.zeros(len(pairing.weights)), resting)
    rises, fluxes = contact_temperatures((0.01, 0.02), (50.0, 15.0), (100, 20), 0.0, 0.5, 5e3)
    np.testing.assert_allclose(state.rise[0], rises[0], rtol=1e-10)
    np.testing.assert_allclose(state.rise[1], rises[1], rtol=1e-10)
    np.testing.assert_allclose(state.flux[0], fluxes[0], rtol=1e-9)
    rise, heat = (
        conducting.solve(face.nodal_heat(state, bath=True)),
        face.nodal_heat(state, bath=False),
    )
    cooled, held, carried = conducting.losses(rise, heat)
    turnover = conducting.exchanged_heat(rise, heat)
    assert abs(held) < 1e-10 * turnover
    assert cooled == carried == 0.0
    through = abs(fluxes[0]) * pairing.weights.sum()
    assert turnover == pytest.approx(2 * through, rel=1e-9)  # in at one end, out at the other


@pytest.mark.parametrize("h", [2e3, inf])
def test_insulated_body_is_held_by_the_other(h):
    """requirement: a body without cooling of its own is no singular matrix."""
    _, pairing, _, _, face, resting = interface(3, (2, 3), given={"lower_end": 0.0})
    made = np.full(len(pairing.weights), 1e5)
    state = face.exchange(everywhere(pairing, h)).state(made, resting)
    np.testing.assert_allclose(state.flux[0], 0.0, atol=1e-4)
    np.testing.assert_allclose(state.flux[1], 1e5, rtol=1e-9)
    np.testing.assert_allclose(state.rise[1], 1e5 * 0.02 / 15, rtol=1e-9)


@pytest.mark.parametrize("h", [2e3, inf])
def test_separated_points_exchange_no_heat(h):
    """requirement: conductance acts only where the faces touch."""
    _, pairing, _, _, face, resting = interface(4, (4, 4))
    closed = pairing.points[:, 0] < 0.07
    exchange = face.exchange(np.where(closed, h, 0.0))
    state = exchange.state(np.where(closed, 1e5, 0.0), resting)
    for flux in state.flux:
        assert np.abs(flux[~closed]).max() == 0.0
    assert np.abs(state.rise[0] - state.rise[1])[~closed].max() > 0.1
    total = pairing.weights @ (state.flux[0] + state.flux[1])
    assert total == pytest.approx(pairing.weights @ np.where(closed, 1e5, 0.0), rel=1e-10)


def test_condensed_distortion_equals_the_bodies_own():
    """requirement: H q from the adjoint is the weak gap of the heated bodies, to 1e-9; and heat
    closes the gap (the faces bulge towards each other).
    """
    given = {"upper_end": 80.0, "lower_end": 30.0}
    bodies, pairing, conducting, basis, face, _ = interface(5, (3, 4), given=given)
    materials = {
        "upper": ElasticMaterial(2e11, 0.3, 1.2e-5),
        "lower": ElasticMaterial(1e11, 0.2, 2e-5),
    }
    elastic = elasticity(bodies, Axisymmetric(), 5, materials, ["upper_end", "lower_end"])
    trace = gap_trace(elastic.spaces, Contacts((pairing,)))
    holder = hold(
        Contacts((pairing,)), pairing.normals, [RigidMode(translation((0, -1)), load=1.0)]
    )
    load = elastic.thermal_load(conducting.spaces)
    answers = influence(elastic, pairing.weights, trace, basis, [load])
    contact, loads = answers.condensed(trace, holder), pressure_loads(trace, answers.weighted)
    opening = ThermalOpening(elastic, loads, [load], answers.per_rise)
    distortion = condense_distortion(conducting, opening, face.nodes)
    still = conducting.solve(np.zeros(len(conducting.fixed)))
    rest = baseline_response(still, face.traces, COMM, opening.of([still]))
    exchange = face.exchange(np.where(pairing.points[:, 0] < 0.08, 3e3, 0.0))
    coupled = distortion.coupled(exchange)
    resting = coupled.baseline_gap(rest)
    q = 1e5 * np.exp(-pairing.points[:, 0] / 0.05)
    rise = conducting.solve(face.nodal_heat(exchange.state(q, rest), bath=True))
    gap = sum_over_ranks(COMM, trace.T @ elastic.solve(load.multiply(rise)))
    weak = contact.weak(gap)
    np.testing.assert_allclose(
        coupled.by_friction(q) + resting, weak, rtol=1e-7, atol=1e-9 * np.abs(weak).max()
    )
    assert np.all(weak < 0)


@pytest.mark.parametrize("stored", [True, False])
def test_opening_by_temperatures(stored):
    """requirement: the weak gap opened by temperatures, at once or by columns, is that of the
    bodies strained by them; an additional strain of one of them by its slope included.
    """
    bodies, pairing, conducting, basis, _, _ = interface(2, (2, 3))
    materials = {part: ElasticMaterial(2e11, 0.3, 1.2e-5) for part in MATERIALS}
    elastic = elasticity(bodies, Axisymmetric(), 2, materials, ["upper_end", "lower_end"])
    trace = gap_trace(elastic.spaces, Contacts((pairing,)))
    matrices = [elastic.thermal_load(conducting.spaces, only) for only in (None, "lower")]
    answers = influence(elastic, pairing.weights, trace, basis, matrices)
    loads = pressure_loads(trace, answers.weighted)
    opening = ThermalOpening(elastic, loads, matrices, answers.per_rise if stored else ())
    slope, *rises = np.random.default_rng(3).random((3, len(conducting.fixed)))
    strained = [matrix.multiply(rise) for matrix, rise in zip(matrices, rises, strict=True)]
    expected = answers.weighted.T @ sum_over_ranks(COMM, trace.T @ elastic.solve(sum(strained)))
    np.testing.assert_allclose(opening.of(rises), expected, rtol=1e-9)
    spaces, found = conducting.spaces, np.zeros(loads.shape[1])
    for body, columns, block in opening.by_columns(spaces, [slope]):
        found[columns] += sum_over_ranks(COMM, block.T @ spaces.split(rises[0])[body])
    expected = opening.of([rises[0], slope * rises[0]])
    np.testing.assert_allclose(found, expected, rtol=1e-9)
