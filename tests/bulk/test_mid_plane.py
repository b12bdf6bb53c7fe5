"""Supports normal to planes z = const: exact states of a block, and motions left free."""

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Spatial
from thermowear.bulk.solvers.choice import SolverChoice
from thermowear.bulk.solvers.multigrid import MultigridSolver
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.geometry.mesh.held import free_motions

from ..contact.solids import COMM, bent, two_solids

E, NU, EXPANSION, PRESSURE, RISE = 7e10, 0.3, 1.2e-5, 3e7, 80.0
LOW_X, LOW_Y = (tuple(f"{b}_low_{axis}" for b in ("upper", "lower")) for axis in "xy")
ENDS = "upper_end", "lower_end"
HEIGHTS = {"upper": 0.02, "lower": -0.03}


def held_in_planes(cell_type, solver, clamped=(), symmetric=LOW_X, rollers=LOW_Y):
    tagged = two_solids(((2, 2, 2), (3, 2, 2)), 1, (bent, bent), cell_type)
    bodies = distribute(tagged if COMM.rank == 0 else None, COMM)
    materials = dict.fromkeys(HEIGHTS, ElasticMaterial(E, NU, EXPANSION))
    choice = SolverChoice(solver)
    return elasticity(
        bodies, Spatial(), 2, materials, clamped, symmetric, rollers, choice, mid_plane=ENDS
    )


@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
@pytest.mark.parametrize(("solver", "within"), [("direct", 1e-10), ("multigrid", 1e-7)])
def test_uniaxial_stress_and_free_expansion(cell_type, solver, within):
    """
    requirement: a block on a plane z = z0 under a uniform pressure is in uniaxial stress,
    u_z = -p (z - z0) / E and u_x = ν p x / E; heated evenly it expands freely, without reactions.
    """
    problem = held_in_planes(cell_type, solver)
    assert isinstance(problem.groups[0].factor, MultigridSolver) is (solver == "multigrid")
    nodes = problem.nodes()
    level = np.where(problem.owned_by("upper"), *HEIGHTS.values())
    from_planes = nodes - np.column_stack([0 * level, 0 * level, level])
    squeezed = problem.spaces.loads(problem.pressure_work("upper_face", PRESSURE))
    squeezed += problem.spaces.loads(problem.pressure_work("lower_face", PRESSURE))
    strain = PRESSURE / E * np.array([NU, NU, -1.0])
    found = problem.solve(squeezed).reshape(nodes.shape)
    np.testing.assert_allclose(found, strain * from_planes, rtol=0.0, atol=within * 1e-5)
    rises = lagrange_spaces(problem.bodies, 2)
    heated = problem.thermal_load(rises).multiply(np.full(rises.owned, RISE))
    found = problem.solve(heated)
    np.testing.assert_allclose(
        found.reshape(nodes.shape), EXPANSION * RISE * from_planes, rtol=0.0, atol=within * 1e-5
    )
    largest = np.abs(heated).max()
    assert np.abs(problem.reactions(found, heated)).max() < 1e3 * within * largest


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
def test_only_the_normal_displacement_is_held(solver):
    """requirement: on the plane u_z = 0, and it bears no shear: all of it goes to the clamp."""
    problem = held_in_planes("tetrahedron", solver, clamped=LOW_X, symmetric=(), rollers=())
    loads = problem.spaces.loads(problem.surface_work("lower_face", np.array([2e3, 1e3, -5e3])))
    u = problem.solve(loads).reshape(-1, 3)
    reactions = problem.reactions(u.ravel(), loads).reshape(-1, 3)
    x, _, z = problem.nodes().T
    on_plane = (np.abs(z - HEIGHTS["lower"]) < 1e-9) & (x > 1e-9)
    assert np.abs(u[on_plane, 2]).max() < 1e-9 * np.abs(u).max()
    assert np.abs(u[on_plane, :2]).max() > 0.1 * np.abs(u[:, :2]).max()
    assert np.abs(reactions[on_plane, :2]).max() == 0.0
    assert np.abs(reactions[on_plane, 2]).sum() > 100.0


@pytest.mark.parametrize(
    ("clamped", "guided", "free"),
    [
        ((), ((), (), ENDS), ["along x", "along y", "about z"]),
        ((), (LOW_X, (), ENDS), ["along y"]),
        ((), ((), LOW_Y, ENDS), ["along x"]),
        ((), (LOW_X, LOW_Y, ENDS), []),
        (("lower_low_x",), ((), (), ENDS), []),
        (("lower_low_x",), ((), (), ()), []),
        ((), (LOW_X, LOW_Y, ()), ["along z"]),
        (("upper_end",), ((), (), ()), "all"),
        ((), (("lower_high_y",), (), ()), ["along y", "along z", "about x", "about z"]),
    ],
)
def test_motions_left_free(clamped, guided, free):
    """requirement: the rigid motions that deform no support, of a block off the origin, too."""
    every = ["along x", "along y", "along z", "about x", "about y", "about z"]
    for shift in (0.0, 5.0):
        tagged = two_solids()
        tagged.points[:] += [shift, -2 * shift, 3 * shift]
        found = free_motions(tagged, ["lower"], clamped, guided)
        assert found == (every if free == "all" else free)


def test_size_of_the_support_does_not_matter():
    """requirement: a single clamped facet holds a body, one of a thousand times its size, too."""
    tagged = two_solids(((2, 2, 2), (200, 1, 1)))
    below = tagged.facet_tags == 1 + tagged.surfaces.index("lower_end")
    one = np.flatnonzero(below)[0]
    for other in tagged.surfaces[:2]:
        tagged.facet_tags[tagged.facet_tags == 1 + tagged.surfaces.index(other)] = 0
    tagged.facet_tags[one] = 1
    assert len(tagged.facets_of(tagged.surfaces[0])) == 1
    tagged.points[:] *= [10.0, 1.0, 1.0]
    assert free_motions(tagged, ["lower"], tagged.surfaces[:1], ((), (), ())) == []
