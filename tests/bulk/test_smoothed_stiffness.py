"""Stiffness of linear tetrahedra with strains smoothed over the cells at an edge."""

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.body import edge_smoothed_stiffness
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Spatial
from thermowear.bulk.solvers.direct import multiply

from ..contact.solids import COMM, bent, two_solids

MATERIALS = {"upper": ElasticMaterial(2e11, 0.3), "lower": ElasticMaterial(1e10, 0.4)}
VOLUME = 0.04 * 0.03 * 0.02


@pytest.fixture(scope="module")
def body():
    """Upper body in linear tetrahedra of unequal shape."""
    tagged = two_solids(((5, 4, 2), (2, 2, 2)), 1, (bent, bent), "tetrahedron")
    bodies = distribute(tagged if COMM.rank == 0 else None, COMM)
    return elasticity(bodies, Spatial(), 1, MATERIALS, ["upper_end", "lower_end"]).each[0]


def moved(body, field):
    """Nodal displacements of a field x (n, 3), owned values."""
    count = body.space.dofmap.index_map.size_local
    return field(body.space.tabulate_dof_coordinates()[:count]).ravel()


def energies(body, field):
    """Strain energies of smoothed and of linear elements [J]."""
    u = moved(body, field)
    smoothed = edge_smoothed_stiffness(body.space, body.lame[:2])
    found = [0.5 * u @ multiply(matrix, u) for matrix in (smoothed, body.stiffness(body.space))]
    return COMM.allreduce(np.array(found))


def test_uniform_strain_is_exact(body):
    """requirement: energy of a uniform strain is that of Hooke's law, whatever the cells."""
    H = 1e-3 * np.array([[2.0, 0.5, -1.0], [0.1, -3.0, 0.7], [0.4, 0.2, 1.0]])
    ε = (H + H.T) / 2
    λ, μ = 2e11 * 0.3 / (1.3 * 0.4), 2e11 / 2.6
    exact = VOLUME * (λ / 2 * np.trace(ε) ** 2 + μ * np.sum(ε * ε))
    np.testing.assert_allclose(energies(body, lambda x: x @ H.T), exact, rtol=1e-12)


def test_rigid_motions_need_no_force(body):
    """requirement: translations and small rotations strain nothing."""
    matrix = edge_smoothed_stiffness(body.space, body.lame[:2])
    for spin in (*np.eye(3), np.zeros(3)):
        u = moved(body, lambda x, spin=spin: np.cross(spin, x) + np.array([0.01, -0.02, 0.03]))
        scale = np.abs(matrix.getDiagonal().getArray()).max() * np.abs(u).max()
        assert np.abs(multiply(matrix, u)).max() < 1e-13 * scale


def test_bending_is_softer_than_by_linear_elements(body):
    """requirement: pure bending costs less energy, not less than half of the exact one."""
    E, ν, curvature = 2e11, 0.3, 0.1

    def bending(x):
        x, y, z = (x - np.array([0.02, 0.015, 0.01])).T
        u = curvature * x * z, -ν * curvature * y * z
        w = -curvature / 2 * (x**2 + ν * (z**2 - y**2))
        return np.stack([*u, w], axis=1)

    exact = E / 2 * curvature**2 * 0.04 * 0.03 * 0.02**3 / 12
    smoothed, linear = energies(body, bending)
    assert linear > 1.2 * exact
    assert 0.5 * exact < smoothed < exact + 0.5 * (linear - exact)


def test_a_matrix_of_its_own_is_symmetric(body):
    """requirement: symmetric, and regular with a support as the one of linear elements is."""
    matrix = edge_smoothed_stiffness(body.space, body.lame[:2])
    assert matrix.isSymmetric(tol=1e-12 * matrix.norm()) or COMM.size > 1
    assert matrix.getSizes() == body.stiffness(body.space).getSizes()
