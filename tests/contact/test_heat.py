"""Heat at the interface, on two blocks in which it flows straight down."""

from math import inf

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.conduction import conduction
from thermowear.bulk.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.field import lagrange_space
from thermowear.bulk.kinematics import Axisymmetric
from thermowear.contact.condensation import condense
from thermowear.contact.face import gather_face
from thermowear.contact.heat import bath_matrix, condense_distortion, condense_heat
from thermowear.contact.holder import Drive, hold
from thermowear.contact.pairing import pair
from thermowear.contact.pressure import pressure_basis
from thermowear.contact.traces import gap_trace, value_trace
from thermowear.laws.motions import translation
from thermowear.parallel import sum_over_ranks
from thermowear.reference import slabs

from ..conftest import two_blocks

COMM = MPI.COMM_WORLD
CONDUCTIVITIES = {"upper": 50.0, "lower": 15.0}


def interface(degree, columns, conductance, partition=0.5, given=None, cooling=None):
    tagged = two_blocks(heights=(0.01, 0.02), columns=columns) if COMM.rank == 0 else None
    bodies = distribute(tagged, COMM)
    pairing = pair(
        gather_face(bodies, "upper_face"),
        gather_face(bodies, "lower_face"),
        Axisymmetric(),
        degree + 2,
    )
    space = lagrange_space(bodies.mesh, degree)
    traces = tuple(value_trace(space, side) for side in pairing.sides)
    shift = 1000.0
    bath = bath_matrix(space, traces, pairing.weights, shift)
    given = {"upper_end": 0.0, "lower_end": 0.0} if given is None else given
    conducting = conduction(
        bodies, Axisymmetric(), space, CONDUCTIVITIES, cooling or {}, given, bath
    )
    basis = pressure_basis(pairing, max(degree - 1, 1))
    face = condense_heat(conducting, pairing.weights, basis, traces, shift, conductance, partition)
    return bodies, pairing, conducting, basis, face


def everywhere(pairing):
    return np.ones(len(pairing.weights), dtype=bool)


@pytest.mark.parametrize("columns", [(3, 3), (3, 4)])
@pytest.mark.parametrize("h", [0.0, 1e3, 1e4, inf])
@pytest.mark.parametrize("f", [0.5, 0.2])
def test_two_slabs(h, f, columns):
    """requirement: temperatures and fluxes of two slabs with friction heat between them, to 1e-9.

    The published figures (q = 1e5 W/m²): h = 1e3 gives 14.47368 and 36.84211 K, q1 = 72368.42.
    """
    _, pairing, _, _, face = interface(3, columns, None if h == inf else h, f)
    state = face.exchange(everywhere(pairing)).state(np.full(len(pairing.weights), 1e5))
    rises, fluxes = slabs.contact_temperatures((0.01, 0.02), (50.0, 15.0), (0, 0), 1e5, f, h)
    for found, exact in zip((*state.rise, *state.flux), (*rises, *fluxes), strict=True):
        np.testing.assert_allclose(found, exact, rtol=1e-9, atol=1e-6)
    if (h, f) == (1e3, 0.5):
        assert (*rises, fluxes[0]) == pytest.approx((14.47368, 36.84211, 72368.42), rel=1e-6)


def test_given_end_temperatures():
    """requirement: heat crosses the contact from the hot end to the cold one."""
    given = {"upper_end": 100.0, "lower_end": 20.0}
    _, pairing, conducting, _, face = interface(2, (3, 2), 5e3, given=given)
    state = face.exchange(everywhere(pairing)).state(np.zeros(len(pairing.weights)))
    rises, fluxes = slabs.contact_temperatures((0.01, 0.02), (50.0, 15.0), (100, 20), 0.0, 0.5, 5e3)
    np.testing.assert_allclose(state.rise[0], rises[0], rtol=1e-10)
    np.testing.assert_allclose(state.rise[1], rises[1], rtol=1e-10)
    np.testing.assert_allclose(state.flux[0], fluxes[0], rtol=1e-9)
    net, turnover = conducting.outflow(
        conducting.solve(face.nodal_heat(state, bath=True)), face.nodal_heat(state, bath=False)
    )
    assert abs(net) < 1e-10 * turnover
    through = abs(fluxes[0]) * pairing.weights.sum()
    assert turnover == pytest.approx(2 * through, rel=1e-9)  # in at one end, out at the other


@pytest.mark.parametrize("h", [2e3, None])
def test_insulated_body_is_held_by_the_other(h):
    """requirement: a body without cooling of its own is no singular matrix."""
    _, pairing, _, _, face = interface(3, (2, 3), h, given={"lower_end": 0.0})
    state = face.exchange(everywhere(pairing)).state(np.full(len(pairing.weights), 1e5))
    np.testing.assert_allclose(state.flux[0], 0.0, atol=1e-4)
    np.testing.assert_allclose(state.flux[1], 1e5, rtol=1e-9)
    np.testing.assert_allclose(state.rise[1], 1e5 * 0.02 / 15, rtol=1e-9)


@pytest.mark.parametrize("h", [2e3, None])
def test_separated_points_exchange_no_heat(h):
    """requirement: conductance acts only where the faces touch."""
    _, pairing, _, _, face = interface(4, (4, 4), h)
    closed = pairing.points[:, 0] < 0.07
    state = face.exchange(closed).state(np.where(closed, 1e5, 0.0))
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
    bodies, pairing, conducting, basis, face = interface(5, (3, 4), 3e3, given=given)
    materials = {
        "upper": ElasticMaterial(2e11, 0.3, 1.2e-5),
        "lower": ElasticMaterial(1e11, 0.2, 2e-5),
    }
    elastic = elasticity(bodies, Axisymmetric(), 5, materials, ["upper_end", "lower_end"])
    trace = gap_trace(elastic.space, pairing)
    contact = condense(
        elastic,
        pairing,
        trace,
        trace,
        basis,
        hold(pairing, pairing.normals, [Drive(translation((0, -1)), load=1.0)]),
        keep_influence=True,
    )
    load = elastic.thermal_load(conducting.space)
    distortion = condense_distortion(conducting, load, contact, face)
    exchange = face.exchange(pairing.points[:, 0] < 0.08)
    per_heat, resting = distortion.per_friction_heat(exchange)
    q = 1e5 * np.exp(-pairing.points[:, 0] / 0.05)
    rise = conducting.solve(face.nodal_heat(exchange.state(q), bath=True))
    right, forces = load.createVecs()
    right.setArray(rise)
    load.mult(right, forces)
    gap = sum_over_ranks(COMM, trace.T @ elastic.solve(forces.getArray()))
    weak = contact.weak(gap)
    np.testing.assert_allclose(
        per_heat @ q + resting, weak, rtol=1e-7, atol=1e-9 * np.abs(weak).max()
    )
    assert np.all(weak < 0)
