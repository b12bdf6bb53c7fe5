"""Multigrid solver against the direct one, and the choice between them."""

from dataclasses import replace

import numpy as np
import pytest
import ufl

from thermowear.bulk.bodies import distribute
from thermowear.bulk.compiled import assembled_matrix
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.heat.advection import Passage
from thermowear.bulk.heat.heat_equation import (
    ThermalMaterial,
    conduction,
    surface_heat,
    transferring,
)
from thermowear.bulk.kinematics import Spatial
from thermowear.bulk.solvers import choice
from thermowear.bulk.solvers.choice import (
    SolverChoice,
    choose_solver,
    count_unknowns,
    factor_memory,
)
from thermowear.bulk.solvers.multigrid import MultigridSolver
from thermowear.bulk.spaces import block_diagonal, lagrange_spaces
from thermowear.errors import ComputationError

from ..conftest import two_blocks
from ..contact.solids import COMM, two_solids

MULTIGRID = SolverChoice("multigrid")
ENDS = ["upper_end", "lower_end"]


def solids(n=2, cell_type="tetrahedron", order=1):
    tagged = two_solids(((n, n, n), (n + 1, n, n)), order, cell_type=cell_type)
    return distribute(tagged if COMM.rank == 0 else None, COMM)


def elastic(bodies, degree, choice, clamped=ENDS, **supports):
    materials = {"upper": ElasticMaterial(2e11, 0.3), "lower": ElasticMaterial(1e10, 0.4)}
    return elasticity(bodies, Spatial(), degree, materials, clamped, choice=choice, **supports)


def pulled(problem):
    """Loads that bend and press both bodies."""
    on_face = problem.surface_work("upper_face", np.array([1.0, 2.0, -5.0]))
    on_side = problem.surface_work("lower_high_x", np.array([1.0, 0.0, -3.0]))
    return problem.spaces.loads(on_face) + problem.spaces.loads(on_side)


@pytest.mark.parametrize(
    ("cell_type", "order", "degree"),
    [
        ("tetrahedron", 1, 1),
        ("tetrahedron", 1, 2),
        ("tetrahedron", 2, 2),
        ("hexahedron", 1, 2),
        ("hexahedron", 1, 3),
    ],
)
def test_displacements_of_the_direct_solver(cell_type, order, degree):
    """requirement: displacements agree to 1e-7, with rollers and planes of symmetry."""
    bodies = solids(2, cell_type, order)
    supports = {"symmetric": ("upper_low_x",), "rollers": ("lower_low_y",)}
    direct = elastic(bodies, degree, None, **supports)
    multigrid = elastic(bodies, degree, MULTIGRID, **supports)
    assert all(isinstance(group.factor, MultigridSolver) for group in multigrid.groups)
    expected = direct.solve(pulled(direct))
    found = multigrid.solve(np.column_stack([pulled(multigrid), -2 * pulled(multigrid)]))
    tolerance = 1e-7 * np.abs(expected).max()
    np.testing.assert_allclose(found[:, 0], expected, rtol=0.0, atol=tolerance)
    np.testing.assert_allclose(found[:, 1], -2 * expected, rtol=0.0, atol=2 * tolerance)
    assert max(k for group in multigrid.groups for k in group.factor.iterations) <= 30


def test_iterations_do_not_grow_with_the_number_of_unknowns():
    """requirement: at most 12 iterations for quadratic tetrahedra, coarse or fine."""
    counts = []
    for n in (3, 6):
        problem = elastic(solids(n), 2, MULTIGRID)
        problem.solve(pulled(problem))
        counts += [k for group in problem.groups for k in group.factor.iterations]
    assert max(counts) <= 12, counts


def test_plates_of_a_single_layer_bend():
    """requirement: at most 14 iterations where linear elements alone (19) are far too stiff."""

    def flat(p):
        return p * np.array([1.0, 1.0, 0.3])

    tagged = two_solids(((8, 6, 1), (7, 6, 2)), 1, (flat, flat), "tetrahedron")
    bodies = distribute(tagged if COMM.rank == 0 else None, COMM)
    problem = elastic(bodies, 2, MULTIGRID, ["upper_low_x", "lower_low_x"])
    problem.solve(pulled(problem))
    counts = [k for group in problem.groups for k in group.factor.iterations]
    assert max(counts) <= 14, counts


def test_levels_are_given_back():
    """requirement: the same displacements after the levels have been freed, and once more."""
    problem = elastic(solids(), 2, replace(MULTIGRID, single=True))
    first = problem.solve(pulled(problem))
    assert not any("_solver" in vars(group.factor) for group in problem.groups)
    again = problem.solve(pulled(problem))
    np.testing.assert_allclose(again, first, rtol=0.0, atol=1e-9 * np.abs(first).max())


def test_a_body_without_support_is_an_error():
    """requirement: no wrong displacements where the stiffness is singular."""
    problem = elastic(solids(), 2, MULTIGRID, clamped=["upper_end"])
    with pytest.raises(ComputationError, match="multigrid solver has not converged"):
        problem.solve(pulled(problem))


@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
@pytest.mark.parametrize("degree", [1, 2, 3])
def test_unknowns_are_counted_without_a_space(cell_type, degree):
    """requirement: the number of unknowns of the choice is that of the space."""
    bodies = solids(2, cell_type)
    counted = sum(count_unknowns(body.mesh, degree) for body in bodies.each)
    assert counted == lagrange_spaces(bodies, degree, 3).total


@pytest.mark.parametrize(
    ("unknowns", "measured"), [(61_605, 0.49e9), (136_857, 1.43e9), (176_967, 2.1e9)]
)
def test_the_estimated_memory_is_the_measured_one(unknowns, measured):
    """requirement: estimate of a factor within 10 % of measurements."""
    assert factor_memory(unknowns) == pytest.approx(measured, rel=0.1)


def test_the_solver_is_chosen_by_memory_and_size(monkeypatch):
    """requirement: multigrid where a factor does not fit, or for a single solution of many."""
    bodies = solids()
    assert choose_solver("auto", bodies, 2, True).name == "direct"
    assert choose_solver("multigrid", bodies, 2, False).iterative
    assert 1e8 < choose_solver("auto", bodies, 2, True).available < 1e14
    monkeypatch.setattr(choice, "_MANY", {"tetrahedron": 100, "hexahedron": 100})
    assert choose_solver("auto", bodies, 2, True).iterative
    assert not choose_solver("auto", bodies, 2, False).iterative
    assert not choose_solver("direct", bodies, 2, True).iterative
    monkeypatch.setattr(choice, "available_memory", lambda: 1e6)
    chosen = choose_solver("auto", bodies, 2, False)
    assert chosen.iterative
    assert "would not fit" in chosen.note()
    assert not choose_solver("direct", bodies, 2, False).iterative


def test_sections_are_factorised():
    """requirement: no multigrid in sections."""
    bodies = distribute(two_blocks() if COMM.rank == 0 else None, COMM)
    choice = choose_solver("multigrid", bodies, 3, True)
    assert not choice.iterative
    assert choice.note() is None
    assert choice.summary() == {"solver": "direct", "factor_memory_estimate_bytes": None}


@pytest.mark.parametrize("speed", [0.01, 1.0, 1000.0])
def test_heat_carried_along(speed):
    """requirement: temperatures and adjoints of the direct solver at any Péclet number, to 1e-7."""
    bodies, kinematics = solids(3), Spatial()
    spaces, baths = lagrange_spaces(bodies, 2), []
    for body, space in zip(bodies.each, spaces.each, strict=True):
        T, δT = ufl.TrialFunction(space), ufl.TestFunction(space)
        (form,) = transferring(body, kinematics, {"upper_face": 1e4, "lower_face": 1e4})
        baths.append(assembled_matrix(form(T, δT)))
    materials = {"upper": ThermalMaterial(5.0, 3.5e6), "lower": ThermalMaterial(50.0, 3.5e6)}
    cooling, passage = {"upper_end": 500.0}, Passage(("lower",), None, -speed, spread=False)
    both = [
        conduction(
            bodies,
            kinematics,
            spaces,
            materials,
            cooling,
            {"lower_end": 20.0},
            block_diagonal(baths),
            passage,
            choice,
        )
        for choice in (None, MULTIGRID)
    ]
    heat = surface_heat(bodies, kinematics, spaces, "lower_face", 1e5)
    assert isinstance(both[1].factor, MultigridSolver)
    for answer in (lambda c: c.solve(heat), lambda c: c.adjoint_response(heat[:, None])):
        expected, found = map(answer, both)
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-7 * np.abs(expected).max())
    assert max(both[1].factor.iterations) <= 30
