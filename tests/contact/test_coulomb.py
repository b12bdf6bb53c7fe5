"""Signorini's and Coulomb's conditions on made-up compliances."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermowear import ComputationError
from thermowear.contact.friction.coulomb import (
    CoulombProblem,
    CoulombSolution,
    _by_lemke,
    jacobian,
    newton_step,
    residual,
    solve_by_newton,
    solve_with_fallbacks,
    violated,
)
from thermowear.contact.solvers.signorini import solve_contact

from ..conftest import examples


def random_problem(seed, directions=1, forced=False):
    """A compliance that couples everything, rough gaps, friction that differs everywhere."""
    rng = np.random.default_rng(seed)
    m = rng.integers(3, 26)
    total = m * (1 + directions)
    noise = rng.normal(size=(total, total + 3))
    compliance = noise @ noise.T / total
    if rng.random() < 0.7:
        x = np.sort(rng.uniform(-1, 1, m))
        kernel = -np.log(np.abs(np.subtract.outer(x, x)) + 0.05) + np.log(3.0)
        smooth = np.kron(np.eye(1 + directions), kernel) + 0.05 * np.eye(total)
        root = np.linalg.cholesky(smooth)
        compliance = root @ (np.eye(total) + rng.choice([0.0, 0.3]) * compliance) @ root.T
    offset = rng.normal(size=total)
    offset[:m] -= rng.uniform(0, 2)
    friction = rng.uniform(0, 1, m) * rng.choice([0.1, 1.0])
    if not forced:
        return CoulombProblem(compliance, offset, np.zeros((total, 0)), np.zeros(0), friction)
    modes = np.zeros((total, 2))
    modes[:m, 0], modes[m : 2 * m, 1] = 1.0, -1.0
    press = m * rng.uniform(0.1, 3)
    force = np.array([press, rng.uniform(-0.9, 0.9) * press * friction.min()])
    return CoulombProblem(compliance, offset, modes, force, friction)


def solve(problem):
    everywhere = np.ones(len(problem.friction), dtype=bool)
    solution = solve_by_newton(problem, everywhere)
    return solve_with_fallbacks(problem, everywhere) if solution is None else solution


def violations(problem, solution):
    """Largest violation of the conditions, evaluated coefficient by coefficient."""
    λ, τ = solution.pressure, solution.shear
    x = np.concatenate([λ, *τ.T])
    y = problem.compliance @ x + problem.offset - problem.modes @ solution.motion
    size = np.abs(x).max() or 1.0  # all open
    scale = size, np.abs(y).max() + np.abs(problem.compliance).max() * size
    worst = [np.abs(problem.modes.T @ x - problem.force).sum() / size]
    for i, mu in enumerate(problem.friction):
        gap, *slip = y.reshape(-1, len(λ))[:, i]
        worst += [-gap / scale[1], -λ[i] / scale[0], abs(λ[i] * gap) / scale[0] / scale[1]]
        shear, length = np.linalg.norm(τ[i]), np.linalg.norm(slip)
        worst.append((shear - mu * λ[i]) / scale[0])
        if shear < (1 - 1e-9) * mu * λ[i]:
            worst.append(length / scale[1])
        elif shear > 0:  # it slips against the shear
            worst.append(np.linalg.norm(np.array(slip) + length * τ[i] / shear) / scale[1])
    return max(worst)


@settings(max_examples=examples(120), deadline=None)
@given(seed=st.integers(0, 2**32 - 1), directions=st.sampled_from([1, 1, 2]), forced=st.booleans())
def test_every_solution_satisfies_the_conditions(seed, directions, forced):
    """requirement: gap, pressure, friction bound, slip against shear and equilibrium, also under
    forces close to sliding, and with two tangential directions.
    """
    problem = random_problem(seed, directions, forced)
    solution = solve(problem)
    assert violations(problem, solution) < 1e-8
    if not forced:  # close to sliding a force needs more
        assert solution.iterations <= 10


def test_pivoting_finds_the_same():
    """requirement: the last resort of the solver is a method of its own."""
    for seed in range(20):
        problem = random_problem(seed)
        solution, unknowns = solve(problem), _by_lemke(problem)
        scale = np.abs(solution.stacked).max()
        np.testing.assert_allclose(solution.stacked, unknowns, atol=1e-8 * scale)


def test_two_directions_are_one_that_is_turned():
    """requirement: friction is isotropic; nothing prefers an axis."""
    plane = random_problem(3, forced=True)
    m = len(plane.friction)
    flat, across = plane.compliance[:m, :m], plane.compliance[m:, m:]
    angle = np.array([np.cos(0.7), np.sin(0.7)])
    zero = np.zeros((m, m))
    uncoupled = np.block([[flat, zero], [zero, across]])
    plane = dataclasses.replace(plane, compliance=uncoupled)
    modes = np.zeros((3 * m, 3))
    for k in range(3):
        modes[k * m : (k + 1) * m, k] = 1.0 if k == 0 else -1.0
    space = CoulombProblem(
        np.block([[flat, zero, zero], [zero, across, zero], [zero, zero, across]]),
        np.concatenate([plane.offset[:m], *np.outer(angle, plane.offset[m:])]),
        modes,
        np.concatenate([plane.force[:1], angle * plane.force[1]]),
        plane.friction,
    )
    one, two = solve(plane), solve(space)
    np.testing.assert_allclose(two.pressure, one.pressure, atol=1e-8 * one.pressure.max())
    turned = one.shear * angle
    np.testing.assert_allclose(two.shear, turned, atol=1e-7 * one.pressure.max())


@pytest.mark.parametrize("directions", [1, 2])
def test_jacobian(directions):
    """requirement: Taylor test with open, sticking and slipping coefficients; the remainder has
    slope two where friction turns, and is nothing where all is linear.
    """
    seen = set()
    for seed in range(6):
        problem = random_problem(seed, directions, forced=True)
        rng = np.random.default_rng(seed + 1)
        solution = solve(problem)
        start = np.concatenate([solution.stacked, solution.motion])
        start = start * (1 + 0.3 * rng.normal(size=len(start)))
        pressure, _, sticking = problem.projection(start)
        seen |= set(np.where(sticking, "stick", np.where(pressure > 0, "slip", "open")))
        step = np.abs(start).max() * rng.normal(size=len(start))
        value, slope = residual(problem, start), jacobian(problem, start) @ step
        sizes = np.array([1e-4, 1e-5]) * 0.5**seed
        rest = [
            np.abs(residual(problem, start + h * step) - value - h * slope).max() for h in sizes
        ]
        if directions == 1:
            assert max(rest) < 1e-9 * np.abs(sizes[0] * slope).max()
        else:
            assert np.log10(rest[0] / rest[1]) > 1.9
    assert seen == {"open", "stick", "slip"}


def test_without_friction_it_is_contact():
    """requirement: mu = 0 gives the pressure of Signorini's conditions alone."""
    for seed in range(10):
        problem = random_problem(seed)
        m = len(problem.friction)
        problem = dataclasses.replace(problem, friction=np.zeros(m))
        normal = problem.compliance[:m, :m], problem.offset[:m], np.zeros((m, 0)), np.zeros(0)
        expected = solve_contact(*normal).coefficients
        solution = solve(problem)
        np.testing.assert_allclose(solution.pressure, expected, atol=1e-9 * expected.max())
        assert np.all(solution.shear == 0)


def test_too_much_force_is_refused():
    """requirement: no equilibrium, no answer."""
    problem = random_problem(1, forced=True)
    force = problem.force[0] * np.array([1.0, 1.01 * problem.friction.max()])
    problem = dataclasses.replace(problem, force=force)
    with pytest.raises(ComputationError, match="smaller increments"):
        solve(problem)


WRONG = {
    "no tension": {"pressure": [-1e-6, 1.0], "shear": [0.0, 0.0]},
    "no penetration": {"pressure": [0.0, 1 - 1e-6], "shear": [0.0, 0.0]},
    "pressure only where closed": {"pressure": [1 + 1e-6, 1.0], "shear": [0.0, 0.0]},
    "shear within friction": {"pressure": [1.0, 1.0], "shear": [0.5 + 1e-6, 0.0]},
    "slip only at the limit": {"pressure": [1.0, 1.0], "shear": [0.1, 0.0]},
    "slip against shear": {"pressure": [1.0, 1.0], "shear": [0.5, 0.0]},
    "equilibrium": {"pressure": [1.0, 1.0], "shear": [0.0, 0.0], "force": [2 + 1e-6]},
    "finite": {"pressure": [np.nan, 1.0], "shear": [0.0, 0.0]},
}


@pytest.mark.parametrize("condition", WRONG)
def test_every_violation_is_seen(condition):
    """requirement: the check of a solution sees each condition fail."""
    data = dict(WRONG[condition])
    force = np.array(data.pop("force", []))
    modes = np.zeros((4, len(force)))
    modes[:2] = 1.0
    problem = CoulombProblem(np.eye(4), -np.array([1.0, 1, 0, 0]), modes, force, np.full(2, 0.5))
    shear = np.array(data["shear"])[:, None]
    motion, sticking = np.zeros(len(force)), np.ones(2, dtype=bool)
    solution = CoulombSolution(np.array(data["pressure"]), shear, motion, sticking, 0)
    assert condition in violated(problem, solution)
    right = CoulombSolution(np.ones(2), np.zeros((2, 1)), motion, sticking, 0)
    assert condition == "equilibrium" or not violated(problem, right)


@pytest.mark.parametrize("directions", [1, 2])
def test_open_coefficients_are_eliminated(directions):
    """requirement: Newton's step is that of the whole system, wherever it starts."""
    for seed in range(8):
        problem = random_problem(seed, directions, forced=True)
        rng = np.random.default_rng(seed + 1)
        solution = solve(problem)
        start = np.concatenate([solution.stacked, solution.motion])
        start = start + 0.2 * np.abs(start).max() * rng.normal(size=len(start))
        error = residual(problem, start)
        matrix, found = jacobian(problem, start), newton_step(problem, start, error)
        if np.linalg.matrix_rank(matrix) < len(matrix):  # nothing closed carries the forces
            assert found is None
            continue
        whole = np.linalg.solve(matrix, -error)
        np.testing.assert_allclose(found, whole, atol=1e-8 * np.abs(whole).max())
