"""Elasticity condensed to the contact, against the bodies solved directly."""

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Axisymmetric
from thermowear.bulk.solvers import direct
from thermowear.contact.faces.face import gather_face
from thermowear.contact.operators.condensation import condense, gap_trace, influence, vector_trace
from thermowear.contact.operators.pressure import pressure_basis
from thermowear.contact.operators.rigid_motion import RigidMode, hold
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.contact.solvers.signorini import solve_contact
from thermowear.laws.motions import translation
from thermowear.parallel import sum_over_ranks

from ..conftest import two_blocks

COMM = MPI.COMM_WORLD


def condensed(degree, columns, poisson_ratio=0.3):
    tagged = two_blocks(columns=columns) if COMM.rank == 0 else None
    bodies = distribute(tagged, COMM)
    materials = {
        "upper": ElasticMaterial(2e11, poisson_ratio),
        "lower": ElasticMaterial(7e10, poisson_ratio),
    }
    elastic = elasticity(bodies, Axisymmetric(), degree, materials, ["upper_end", "lower_end"])
    pairing = pair(
        gather_face(bodies, "upper_face"),
        gather_face(bodies, "lower_face"),
        Axisymmetric(),
        degree + 2,
    )
    trace = gap_trace(elastic.spaces, Contacts((pairing,)))
    basis = pressure_basis(pairing, max(degree - 1, 1))
    holder = hold(
        Contacts((pairing,)), pairing.normals, [RigidMode(translation((0.0, -1.0)), load=1.0)]
    )
    contact = condense(elastic, pairing.weights, trace, trace, basis, holder)
    return elastic, pairing, trace, contact


@pytest.mark.parametrize("columns", [(3, 3), (2, 5)])
@pytest.mark.parametrize("degree", [1, 2, 6])
def test_compliance_is_the_bodies_own(degree, columns):
    """requirement: A λ is the weak gap that the bodies show under the pressure Ψ λ; A is SPD."""
    elastic, pairing, trace, contact = condensed(degree, columns)
    λ = np.random.default_rng(1).uniform(0, 1e8, contact.basis.shape[1])
    u = elastic.solve(trace @ (pairing.weights * (contact.basis @ λ)))
    gap = sum_over_ranks(COMM, trace.T @ u)
    weak = contact.weak(gap)
    np.testing.assert_allclose(contact.compliance @ λ, weak, rtol=1e-9)
    assert np.linalg.eigvalsh(contact.compliance).min() > 0
    assert np.all(gap > 0)  # pressure opens the gap of bodies that are held


def test_blocks_of_columns(monkeypatch):
    """requirement: the compliance is the same however many columns are solved for together."""
    _, _, _, whole = condensed(6, (3, 3))
    monkeypatch.setattr(direct, "_MOST_COLUMNS", {2: 4})
    _, _, _, parts = condensed(6, (3, 3))
    np.testing.assert_allclose(parts.compliance, whole.compliance, rtol=1e-12)


@pytest.mark.parametrize("columns", [(3, 3), (3, 4), (5, 2)])
@pytest.mark.parametrize("degree", [1, 2, 4])
def test_uniform_pressure(degree, columns):
    """requirement: contact patch test. With ν = 0 two pressed blocks carry a uniform pressure,
    whether their faces match or not.
    """
    _, pairing, _, contact = condensed(degree, columns, poisson_ratio=0.0)
    area = pairing.weights.sum()
    solution = solve_contact(
        contact.compliance, contact.weak(pairing.gap), contact.modes, np.array([1e8 * area])
    )
    pressure = contact.basis @ solution.coefficients
    np.testing.assert_allclose(pressure, 1e8, rtol=1e-9)
    assert solution.motion[0] == pytest.approx(1e8 * (0.02 / 2e11 + 0.03 / 7e10), rel=1e-9)


@pytest.mark.parametrize("columns", [(3, 3), (2, 5)])
def test_another_friction_needs_no_new_solution(columns, monkeypatch):
    """requirement: one influence gives the bodies' own compliance under any friction."""
    elastic, pairing, trace, _ = condensed(4, columns)
    basis = pressure_basis(pairing, 3)
    answers = influence(elastic, pairing.weights, trace, basis)
    along = np.broadcast_to([1.0, 0.0], pairing.normals.shape)
    holder = hold(
        Contacts((pairing,)), pairing.normals, [RigidMode(translation((0.0, -1.0)), load=1.0)]
    )
    λ = np.random.default_rng(1).uniform(0, 1e8, basis.shape[1])
    for friction in (-0.3, 0.6):
        traction = vector_trace(
            elastic.spaces, Contacts((pairing,)), pairing.normals + friction * along
        )
        u = elastic.solve(traction @ (pairing.weights * (basis @ λ)))
        with monkeypatch.context() as patch:
            patch.setattr(type(elastic), "solve", None)
            contact = answers.condensed(traction, holder)
        weak = contact.weak(sum_over_ranks(COMM, trace.T @ u))
        np.testing.assert_allclose(contact.compliance @ λ, weak, rtol=1e-9)
        asymmetry = np.abs(contact.compliance - contact.compliance.T).max()
        assert asymmetry > 1e-3 * np.abs(contact.compliance).max()
