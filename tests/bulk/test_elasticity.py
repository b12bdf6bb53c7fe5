"""Axisymmetric elasticity and thermal strain."""

from mpi4py import MPI

import numpy as np
import pytest
import ufl

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Axisymmetric
from thermowear.bulk.spaces import lagrange_spaces

from ..conftest import two_blocks
from ..reference import cylinder
from .fields import integral, interpolated, times

STEEL = ElasticMaterial(2e11, 0.3, 1.2e-5)
SOFT = ElasticMaterial(1e9, 0.45, 5e-5)


ENDS, FACES = ("upper_end", "lower_end"), ("upper_face", "lower_face")
EVERYWHERE = tuple(
    f"{b}_{s}" for b in ("upper", "lower") for s in ("end", "face", "inside", "outside")
)


def build(
    degree, columns=3, rows=2, materials=(STEEL, SOFT), clamped=ENDS, growth=(1.3, 0.8), **held
):
    tagged = None
    if MPI.COMM_WORLD.rank == 0:
        tagged = two_blocks(columns=(columns, columns), rows=(rows, rows), growth=growth)
    bodies = distribute(tagged, MPI.COMM_WORLD)
    by_name = dict(zip(("upper", "lower"), materials, strict=True))
    return elasticity(bodies, Axisymmetric(), degree, by_name, list(clamped), **held)


def nodal(elastic, function):
    """Owned nodal values of a vector field given at x of shape (3, n)."""
    return interpolated(elastic.spaces, function)


def residual(elastic, displacement):
    return times(elastic.stiffness, displacement)


@pytest.mark.parametrize("degree", [1, 2, 5])
def test_linear_patch(degree):
    """requirement: a linear field (u_z = c z) is in equilibrium with its tractions to rounding.

    With u_r = 0 the stress is uniform, so interior nodal forces vanish.
    """
    elastic = build(degree)
    forces = residual(elastic, nodal(elastic, lambda x: np.stack([0 * x[0], 1e-3 * x[1]])))
    x = elastic.nodes()
    inner = (x[:, 0] > 0.0501) & (x[:, 0] < 0.0899) & (np.abs(x[:, 1]) > 1e-6)
    inner &= (x[:, 1] < 0.0199) & (x[:, 1] > -0.0299)
    inside = np.repeat(inner, 2)
    assert inside.any()
    assert np.abs(forces[inside]).max() <= 1e-12 * np.abs(forces).max()


def test_thick_walled_cylinder():
    """requirement: Lamé's solution is in equilibrium with its pressure (hoop strain right)."""
    elastic = build(8, materials=(STEEL, STEEL))
    p, inner, outer = 1e8, 0.05, 0.09

    def exact(x):
        return np.stack([cylinder.radial_displacement(x[0], inner, outer, p, 2e11, 0.3), 0 * x[0]])

    forces = residual(elastic, nodal(elastic, exact))[::2]
    r = elastic.nodes()[:, 0]
    total = elastic.bodies.comm.allreduce(forces[np.abs(r - inner) < 1e-9].sum())
    assert total == pytest.approx(p * 2 * np.pi * inner * 0.05, rel=1e-8)
    assert np.abs(forces[np.abs(r - inner) > 1e-9]).max() <= 1e-7 * np.abs(forces).max()


def test_pressure_on_the_surface_inside_a_thick_walled_cylinder():
    """requirement: its nodal loads give Lamé's displacements."""
    elastic = build(6, materials=(STEEL, STEEL), clamped=(), rollers=(*ENDS, *FACES))
    p, inner, outer = 1e8, 0.05, 0.09
    loads = sum(
        elastic.spaces.loads(elastic.pressure_work(f"{b}_inside", p)) for b in ("upper", "lower")
    )
    u = elastic.solve(loads).reshape(-1, 2)
    r = elastic.nodes()[:, 0]
    exact = cylinder.radial_displacement(r, inner, outer, p, 2e11, 0.3)
    np.testing.assert_allclose(u[:, 0], exact, rtol=1e-7)
    assert np.abs(u[:, 1]).max(initial=0.0) < 1e-7 * exact.max(initial=1.0)


def test_free_expansion_has_no_stress():
    """requirement: u = α ΔT x under uniform ΔT: |σ| <= 1e-10 E α ΔT and no nodal forces."""
    elastic = build(3, materials=(STEEL, STEEL))
    spaces = lagrange_spaces(elastic.bodies, 3)
    u = nodal(elastic, lambda x: 1.2e-5 * 100 * x[:2])
    rise = np.full(spaces.owned, 100.0)
    thermal, forces = elastic.thermal_load(spaces).multiply(rise), residual(elastic, u)
    assert np.abs(forces - thermal).max() <= 1e-10 * np.abs(forces).max()
    stresses = _stresses(elastic, u, spaces, rise)
    energy = integral(elastic.bodies, *(ufl.inner(σ, σ) * ufl.dx for σ in stresses))
    assert np.sqrt(energy / (0.04 * 0.05)) <= 1e-10 * 2e11 * 1.2e-5 * 100


def test_compressibility_of_the_least_compressible_body():
    """requirement: ``1 - 2 ν`` with the largest Poisson's ratio."""
    assert build(1).compressibility() == pytest.approx(1 - 2 * SOFT.poisson_ratio)


def test_clamped_heating():
    """requirement: fully constrained heating gives σ = -E α ΔT/(1 - 2ν) in all directions."""
    elastic = build(2, materials=(STEEL, STEEL))
    spaces = lagrange_spaces(elastic.bodies, 2)
    at_rest, rise = np.zeros(elastic.spaces.owned), np.full(spaces.owned, 50.0)
    stresses = _stresses(elastic, at_rest, spaces, rise)
    area = 0.04 * 0.05
    for i in range(3):
        mean = integral(elastic.bodies, *(σ[i, i] * ufl.dx for σ in stresses)) / area
        assert mean == pytest.approx(-2e11 * 1.2e-5 * 50 / (1 - 0.6), rel=1e-12)


def _stresses(elastic, displacement, spaces, rise):
    """Stress of each body."""
    fields = elastic.spaces.functions(displacement, "u"), spaces.functions(rise, "T")
    return [body.stress(u, T) for body, u, T in zip(elastic.each, *fields, strict=True)]


def galerkin_error(degree, n):
    """L2 and H1 error of the solution for a smooth exact field that vanishes on all boundaries.

    (Clamped all round: where a clamped edge meets a free one, duality costs the L2 error an order.)
    """
    elastic = build(degree, n, n, (STEEL, STEEL), EVERYWHERE, (1.0, 1.0))
    dx = ufl.dx(metadata={"quadrature_degree": 2 * degree + 6})
    exact = [_wave(body.mesh) for body in elastic.bodies.each]
    works = [_work_of(body, field, dx) for body, field in zip(elastic.each, exact, strict=True)]
    found = elastic.spaces.functions(elastic.solve(elastic.spaces.loads(works)), "u")
    errors = [u - field for u, field in zip(found, exact, strict=True)]
    slopes = [ufl.grad(error) for error in errors]
    return [
        np.sqrt(integral(elastic.bodies, *(ufl.inner(e, e) * dx for e in each)))
        for each in (errors, slopes)
    ]


def _work_of(body, exact, dx):
    """Work of the stress of a displacement, as a function of the test function."""
    r = ufl.SpatialCoordinate(body.body.mesh)[0]
    strain = Axisymmetric().strain
    return lambda v: (2 * np.pi * r * ufl.inner(body.stress(exact), strain(body.body.mesh, v)) * dx)


def _wave(mesh):
    """Smooth displacement that vanishes on all boundaries."""
    x = ufl.SpatialCoordinate(mesh)
    wave = ufl.conditional(
        ufl.gt(x[1], 0), ufl.sin(ufl.pi * x[1] / 0.02), ufl.sin(ufl.pi * x[1] / 0.03)
    )
    wave *= ufl.sin(ufl.pi * (x[0] - 0.05) / 0.04)
    return 1e-5 * ufl.as_vector([wave * ufl.exp(x[0] / 0.05), wave * ufl.cos(x[0] / 0.02)])


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_convergence(degree):
    """requirement: errors fall with slopes k + 1 and k (± 0.15)."""
    meshes = [4, 8, 16]
    errors = np.log([galerkin_error(degree, n) for n in meshes])
    slopes = -np.polyfit(np.log(meshes), errors, 1)[0]
    assert slopes == pytest.approx([degree + 1, degree], abs=0.15)


def test_supports_carry_the_load():
    """requirement: reactions balance the applied forces."""
    elastic = build(4)
    loads = nodal(elastic, lambda x: np.stack([0 * x[0], np.exp(20 * x[0])]))
    u = elastic.solve(loads)
    comm = elastic.bodies.comm
    reactions = comm.allreduce(elastic.reactions(u, loads)[1::2].sum())
    assert reactions == pytest.approx(-comm.allreduce(loads[1::2].sum()), rel=1e-10)
