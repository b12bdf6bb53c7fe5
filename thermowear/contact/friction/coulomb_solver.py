"""Semismooth Newton method for frictional contact with fallback starts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...errors import ComputationError
from ..solvers.lemke import lemke
from ..solvers.signorini import saddle_point
from .coulomb import CoulombProblem, CoulombSolution, newton_step, residual, scales, violated

_MAX_ITERATIONS = 30
_TOLERANCE = 1e-12
_SPRING_RATIOS = (1e-3, 1e-2, 1e-1, 1.0)  # relative to the contact stiffness, tried in turn
_MAX_SPRING_UPDATES = 20


def solve_by_newton(
    problem: CoulombProblem, closed: np.ndarray, near: np.ndarray | None = None
) -> CoulombSolution | None:
    """Solve by Newton's method in a few iterations; None if it fails.

    Parameters
    ----------
    problem : CoulombProblem
    closed : ndarray of bool, shape (m,)
        Coefficients that are expected to press; the first guess sticks there.
    near : ndarray, shape (M + k,), optional
        Unknowns of a similar problem, tried as the first guess.
    """
    solution = None if near is None else _verified_from(problem, near, (False,))
    if solution is None:
        start = _sticking(problem, closed)
        solution = None if start is None else _verified_from(problem, start)
    return solution


def solve_with_fallbacks(problem: CoulombProblem, closed: np.ndarray) -> CoulombSolution:
    """Solve a problem for which `solve_by_newton` fails; same arguments.

    Newton's method starts from solutions with a spring between holder and load, which exist in
    gross slip too, and finally from the solution by complementary pivoting.

    Raises
    ------
    ComputationError
        If no solution is found.
    """
    for start in _fallback_starts(problem, closed):
        solution = _verified_from(problem, start)
        if solution is not None:
            return solution
    raise ComputationError(
        "contact: no pressure and shear satisfy the friction conditions at this load; take "
        "smaller increments, and see that pressure and friction can carry the load"
    )


def _verified_from(
    problem: CoulombProblem, start: np.ndarray, attempts: tuple[bool, ...] = (False, True)
) -> CoulombSolution | None:
    """Verified solution from a start, with full steps, otherwise with damped ones."""
    for damped in attempts:
        solution = _newton(problem, start, damped)
        if solution is not None and not violated(problem, solution):
            return solution
    return None


@np.errstate(over="ignore", invalid="ignore")  # iterates that diverge
def _newton(problem: CoulombProblem, unknowns: np.ndarray, damped: bool) -> CoulombSolution | None:
    for iteration in range(_MAX_ITERATIONS + 1):
        error = residual(problem, unknowns)
        # at least one step: only rounding errors remain
        if iteration and np.all(np.abs(error) <= _TOLERANCE * scales(problem, unknowns)):
            pressure, shear, sticking = problem.projection(unknowns)
            motion = unknowns[len(problem.offset) :]
            return CoulombSolution(pressure, shear, motion, sticking, iteration)
        step = newton_step(problem, unknowns, error)
        if step is None:
            return None
        if damped:
            step = _damped(problem, unknowns, step, float(np.linalg.norm(error)))
        unknowns = unknowns + step
    return None


def _damped(problem: CoulombProblem, unknowns, step, merit: float) -> np.ndarray:
    """Longest of the successively halved steps that reduces the residual, or the shortest."""
    for halvings in range(8):
        trial = step / 2**halvings
        if np.linalg.norm(residual(problem, unknowns + trial)) < (1 - 1e-4 / 2**halvings) * merit:
            break
    return trial


def _sticking(problem: CoulombProblem, closed: np.ndarray) -> np.ndarray | None:
    """Unknowns with sticking contact at the given coefficients; None if singular."""
    total, k = len(problem.offset), len(problem.force)
    held = np.flatnonzero(np.tile(closed, total // len(closed)))
    modes = problem.modes[held]
    if not np.all(np.any(modes != 0.0, axis=0)):
        return None
    found = saddle_point(
        problem.compliance[np.ix_(held, held)],
        modes,
        modes,
        problem.offset[held, None],
        problem.force[:, None],
    )
    if found is None:
        return None
    result = np.zeros(total + k)
    result[held], result[total:] = found[: len(held), 0], found[len(held) :, 0]
    return result


def _fallback_starts(problem: CoulombProblem, closed: np.ndarray) -> Iterator[np.ndarray]:
    for part in _SPRING_RATIOS:
        yield from _with_spring(problem, closed, part)
    start = _by_lemke(problem)
    if start is not None:
        yield start


def _with_spring(problem: CoulombProblem, closed: np.ndarray, part: float) -> Iterator[np.ndarray]:
    """Solutions with a spring between the holder and its load, its anchor updated each time.

    ``Rᵀ x = F - k (d - d0)`` adds ``R k⁻¹ Rᵀ`` to the compliance and eliminates the free motions;
    with ``d0 <- d`` it is the method of multipliers for the equilibrium.
    """
    if len(problem.force) == 0:
        return
    modes, force = problem.modes, problem.force
    spring = part * np.diag(modes.T @ np.linalg.solve(problem.compliance, modes))
    softer = problem.compliance + modes / spring @ modes.T
    anchor, start = np.zeros(len(force)), None
    for _ in range(_MAX_SPRING_UPDATES):
        offset = problem.offset - modes @ (anchor + force / spring)
        sprung = replace(
            problem, compliance=softer, offset=offset, modes=modes[:, :0], force=force[:0]
        )
        start = _sticking(sprung, closed) if start is None else start
        solution = None if start is None else _verified_from(sprung, start)
        if solution is None:
            return
        start = solution.stacked
        anchor = anchor + (force - modes.T @ start) / spring
        yield np.concatenate([start, anchor])


def _by_lemke(problem: CoulombProblem) -> np.ndarray | None:
    """Unknowns by Lemke's method for one tangential direction; None if it ends on a ray.

    With ``τ = b_1 - b_2`` the conditions are the copositive complementarity problem of Stewart and
    Trinkle (Int. J. Numer. Methods Eng. 39 (1996) 2673), in (λ, b_1, b_2, slip magnitude) and the
    free motions as differences of two positives; solvable if the motions are given.
    """
    m, k = len(problem.friction), len(problem.force)
    if len(problem.offset) != 2 * m:
        return None
    one, none = np.eye(m), np.zeros((m, m))
    spread = np.block([[one, none, none], [none, one, -one]])  # (λ, b_1, b_2) to x
    size = 1 / np.sqrt(np.diag(problem.compliance))
    border, mixing = np.linalg.qr(problem.modes * size[:, None])
    force = np.linalg.solve(mixing.T, problem.force)
    free = spread.T @ np.hstack([-border, border])
    elastic = spread.T @ (problem.compliance * np.outer(size, size)) @ spread
    cone = np.hstack([np.diag(problem.friction * size[:m] / size[m:]), -one, -one])
    slip = np.vstack([none, one, one])
    matrix = np.block(
        [
            [elastic, slip, free],
            [cone, none, np.zeros((m, 2 * k))],
            [-free.T, np.zeros((2 * k, m + 2 * k))],
        ]
    )
    right = np.concatenate([spread.T @ (problem.offset * size), np.zeros(m), -force, force])
    scale = np.abs(right).max() or 1.0
    solution = lemke(matrix, right / scale)
    if solution is None:
        return None
    x = spread @ solution[: 3 * m] * size
    forward, back = solution[4 * m :].reshape(2, k)
    return scale * np.concatenate([x, np.linalg.solve(mixing, forward - back)])
