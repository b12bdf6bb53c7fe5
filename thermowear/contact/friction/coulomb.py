"""Signorini's and Coulomb's conditions together, for one increment, by Newton's method.

Find pressure coefficients λ, shear coefficients τ and the free motions d of the holder with

    (y_n, y_t) = A (λ, τ) + q - R d,     Rᵀ (λ, τ) = F,
    y_n >= 0,   λ >= 0,   λ y_n = 0,
    |τ| <= mu λ,   y_t = 0 where |τ| < mu λ,   y_t = -κ τ with κ >= 0 elsewhere,

for each coefficient; y_n is the weak gap and y_t the weak slip of the increment. With Bernstein
polynomials ``|t| <= mu p`` then holds at every point. The conditions state that λ and τ are the
projections

    λ = max(0, λ - c y_n),     τ = P(τ - c y_t),     P onto the disc of radius mu max(0, λ - c y_n)

for any c > 0 (Alart and Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353). This nonsmooth
system of equations is solved by `solve_by_newton`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...errors import ComputationError
from ..solvers.lemke import lemke
from ..solvers.signorini import saddle_point, solve_contact

_TOLERANCE = 1e-9


@dataclass(frozen=True)
class CoulombProblem:
    """Data of the problem in the module's docstring; t tangential directions, ``M = m (1 + t)``.

    Attributes
    ----------
    compliance : ndarray, shape (M, M)
        A, symmetric and positive definite [m⁵/N].
    offset : ndarray, shape (M,)
        Weak gap and slip q without tractions [m³].
    modes : ndarray, shape (M, k)
        R, weak modes of the free motions [m²].
    force : ndarray, shape (k,)
        Forces F [N].
    friction : ndarray, shape (m,)
        Coefficients of friction mu.
    unsheared : ndarray, shape (m,)
        Part of the pressure that bears no shear, see `stick_edge` [Pa].
    """

    compliance: np.ndarray
    offset: np.ndarray
    modes: np.ndarray
    force: np.ndarray
    friction: np.ndarray
    unsheared: np.ndarray | float = 0.0

    def limit(self, pressure: np.ndarray) -> np.ndarray:
        """Largest shear under pressures, shape (m,) [Pa]."""
        return self.friction * np.maximum(pressure - self.unsheared, 0.0)

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Parameter c, equal for the tangential directions of a coefficient, (M,) [N/m⁵]."""
        blocks = np.diag(self.compliance).reshape(-1, len(self.friction)).copy()
        blocks[1:] = blocks[1:].mean(axis=0)
        return 1 / blocks.ravel()

    def relative(self, unknowns: np.ndarray) -> np.ndarray:
        """Weak gap and slip y of the increment, shape (M,) [m³].

        Kept for the last unknowns: an iteration asks for it several times.
        """
        if not any(of is unknowns for of, _ in self._last):
            x, d = np.split(unknowns, [len(self.offset)])
            self._last[:] = [(unknowns, self.compliance @ x + self.offset - self.modes @ d)]
        return self._last[0][1]

    @cached_property
    def _last(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Last unknowns with their y."""
        return []

    @cached_property
    def _magnitudes(self) -> np.ndarray:
        return np.abs(self.compliance)

    def sizes(self, unknowns: np.ndarray) -> np.ndarray:
        """Sum of the magnitudes of the terms of y, shape (M,) [m³]."""
        x, d = np.split(np.abs(unknowns), [len(self.offset)])
        return self._magnitudes @ x + np.abs(self.offset) + np.abs(self.modes) @ d

    def projection(self, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Projections of the trial tractions, and the sticking coefficients.

        Returns
        -------
        pressure : ndarray, shape (m,)
        shear : ndarray, shape (m, t)
        sticking : ndarray of bool, shape (m,)
            False also for open coefficients.
        """
        normal, tangential = self.trial(unknowns)
        radius = self.limit(normal)
        length = np.linalg.norm(tangential, axis=1)
        sticking = (length <= radius) & (radius > 0)
        shrink = np.where(sticking, 1.0, radius / np.where(length > 0, length, 1.0))
        return np.maximum(normal, 0.0), shrink[:, None] * tangential, sticking

    def sliding_pressure(self, presses: np.ndarray, drag: np.ndarray) -> np.ndarray:
        """Coefficients λ (m,) where all slide, see `gross_slip.SlidingProblem`."""
        m = len(self.friction)
        compliance = self.compliance[:m, :m].copy()
        modes = self.modes[:m, presses]
        carrying = modes.copy()
        for number, along in enumerate(drag, start=1):
            block = slice(number * m, (number + 1) * m)
            compliance += self.compliance[:m, block] * along
            carrying += along[:, None] * self.modes[block][:, presses]
        force = self.force[presses]
        found = solve_contact(compliance, self.offset[:m], modes, force, force_modes=carrying)
        return found.coefficients

    def trial(self, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Trial tractions ``λ - c y_n``, shape (m,), and ``τ - c y_t``, shape (m, t) [Pa]."""
        x = unknowns[: len(self.offset)]
        blocks = (x - self.stiffness * self.relative(unknowns)).reshape(-1, len(self.friction))
        return blocks[0], blocks[1:].T


def residual(problem: CoulombProblem, unknowns: np.ndarray) -> np.ndarray:
    """Difference of the coefficients from their projections, and imbalance of the forces.

    Parameters
    ----------
    problem : CoulombProblem
    unknowns : ndarray, shape (M + k,)
        x and d.

    Returns
    -------
    ndarray, shape (M + k,) [Pa]
        Forces are divided by the area on which they act.
    """
    pressure, shear, _ = problem.projection(unknowns)
    x = unknowns[: len(problem.offset)]
    unbalanced = (problem.modes.T @ x - problem.force) / _areas(problem)
    return np.concatenate([x - np.concatenate([pressure, shear.T.ravel()]), unbalanced])


def jacobian(problem: CoulombProblem, unknowns: np.ndarray) -> np.ndarray:
    """Generalised (semismooth) derivative of `residual`, shape (M + k, M + k)."""
    every = np.ones(len(problem.friction), dtype=bool)
    return _linearised(problem, unknowns, every, problem.compliance)[0]


def newton_step(
    problem: CoulombProblem, unknowns: np.ndarray, error: np.ndarray
) -> np.ndarray | None:
    """Step of Newton's method from the unknowns with a residual, shape (M + k,); None if singular.

    Open coefficients become zero. They are eliminated, so that the system of equations is that of
    the closed ones.
    """
    m, total = len(problem.friction), len(problem.offset)
    closed = problem.trial(unknowns)[0] > 0
    inside = np.tile(closed, total // m)
    kept, gone = np.flatnonzero(inside), np.flatnonzero(~inside & (error[:total] != 0.0))
    change = problem.compliance[np.ix_(kept, gone)] @ -error[gone]
    own = problem.compliance[np.ix_(kept, kept)]
    matrix, moved = _linearised(problem, unknowns, closed, own, change)
    right = -error[np.append(inside, np.ones(len(problem.force), dtype=bool))] + moved
    right[len(kept) :] += problem.modes[gone].T @ error[gone] / _areas(problem)
    try:
        found = np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        return None
    step = np.zeros(len(unknowns))
    step[gone], step[kept], step[total:] = -error[gone], found[: len(kept)], found[len(kept) :]
    return step


def _linearised(
    problem: CoulombProblem,
    unknowns: np.ndarray,
    chosen: np.ndarray,
    compliance: np.ndarray,
    change: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Derivative of the residual of chosen coefficients by them and by the motions.

    Parameters
    ----------
    problem : CoulombProblem
    unknowns : ndarray, shape (M + k,)
    chosen : ndarray of bool, shape (m,)
    compliance : ndarray, shape (u, u)
        Rows and columns of A of the chosen coefficients.
    change : ndarray, shape (u,), optional
        Change of their y by those that are not chosen.

    Returns
    -------
    matrix : ndarray, shape (u + k, u + k)
    moved : ndarray, shape (u + k,)
        Change of their projections by that of y.
    """
    m, k, u = int(chosen.sum()), len(problem.force), len(compliance)
    inside = np.tile(chosen, len(problem.offset) // len(chosen))
    c, modes = problem.stiffness[inside][:, None], problem.modes[inside]
    trial = np.empty((u, u + k + 1))  # derivative of x - c y
    trial[:, :u] = -c * compliance
    trial[np.arange(u), np.arange(u)] += 1.0
    trial[:, u : u + k] = c * modes
    trial[:, -1] = 0.0 if change is None else -c[:, 0] * change
    blocks = trial.reshape(len(inside) // len(chosen), m, u + k + 1)
    normal, tangential = blocks[0], blocks[1:]
    closed, direction, carried, turned = (
        each[chosen] for each in _projection_slopes(problem, unknowns)
    )
    shear = (problem.friction[chosen] * carried)[:, None, None] * direction[..., None]
    projected = np.empty_like(trial)
    projected[:m] = closed[:, None] * normal
    projected[m:] = (
        (shear * normal[:, None] + np.einsum("mij,jmu->miu", turned, tangential))
        .transpose(1, 0, 2)
        .reshape(u - m, u + k + 1)
    )
    result = np.zeros((u + k, u + k))
    result[:u] = -projected[:, :-1]
    result[np.arange(u), np.arange(u)] += 1.0
    result[u:, :u] = modes.T / _areas(problem)[:, None]
    return result, np.append(projected[:, -1], np.zeros(k))


def _projection_slopes(problem: CoulombProblem, unknowns: np.ndarray):
    """Closed mask, direction of the shear, slip mask, and derivative by the trial shear."""
    normal, tangential = problem.trial(unknowns)
    pressure, _, sticking = problem.projection(unknowns)
    length = np.linalg.norm(tangential, axis=1)
    direction = tangential / np.where(length > 0, length, 1.0)[:, None]
    slipping = (pressure > problem.unsheared) & ~sticking
    identity = np.eye(tangential.shape[1])
    across = identity - direction[:, :, None] * direction[:, None, :]
    turn = slipping * problem.limit(pressure) / np.where(length > 0, length, 1.0)
    turned = sticking[:, None, None] * identity + turn[:, None, None] * across
    return normal > 0, direction, slipping, turned


def scales(problem: CoulombProblem, unknowns: np.ndarray) -> np.ndarray:
    """Reference magnitudes of the residual, shape (M + k,) [Pa]."""
    x = np.abs(unknowns[: len(problem.offset)])
    forces = np.abs(problem.modes).T @ x + np.abs(problem.force)
    local = x.max() + problem.stiffness * problem.sizes(unknowns)
    return np.concatenate([local, forces / _areas(problem)])


def _areas(problem: CoulombProblem) -> np.ndarray:
    return np.abs(problem.modes).sum(axis=0)


@dataclass(frozen=True)
class CoulombSolution:
    """Verified solution, with coefficients exactly within their bounds.

    Attributes
    ----------
    pressure : ndarray, shape (m,) [Pa]
    shear : ndarray, shape (m, t) [Pa]
    motion : ndarray, shape (k,) [m]
        Free motions.
    sticking : ndarray of bool, shape (m,)
    iterations : int
        Newton iterations.
    """

    pressure: np.ndarray
    shear: np.ndarray
    motion: np.ndarray
    sticking: np.ndarray
    iterations: int

    @property
    def stacked(self) -> np.ndarray:
        """Stacked coefficients x, shape (M,) [Pa]."""
        return np.concatenate([self.pressure, self.shear.T.ravel()])


def violated(problem: CoulombProblem, solution: CoulombSolution) -> list[str]:
    """Conditions violated by more than 1e-9 of their terms; empty for a solution."""
    x = solution.stacked
    unknowns = np.concatenate([x, solution.motion])
    if not np.all(np.isfinite(unknowns)):
        return ["finite"]
    m = len(problem.friction)
    y, sizes = (f(unknowns).reshape(-1, m) for f in (problem.relative, problem.sizes))
    gap, slip, small = y[0], y[1:].T, _TOLERANCE * sizes
    λ, bound = solution.pressure, problem.limit(solution.pressure)
    carried, slipped = (np.linalg.norm(v, axis=1) for v in (solution.shear, slip))
    nothing = np.linalg.norm(small[1:], axis=0)
    opposed = carried * slipped + (solution.shear * slip).sum(axis=1)
    unbalanced = np.abs(problem.modes.T @ x - problem.force)
    forces = np.abs(problem.modes).T @ np.abs(x) + np.abs(problem.force)
    conditions = {
        "no tension": np.all(λ >= 0),
        "no penetration": np.all(gap >= -small[0]),
        "pressure only where closed": np.all((λ == 0) | (np.abs(gap) <= small[0])),
        "shear within friction": np.all(carried <= bound * (1 + _TOLERANCE)),
        "slip only at the limit": np.all((bound - carried) * slipped <= bound * nothing),
        "slip against shear": np.all(opposed <= bound * nothing),
        "equilibrium": np.all(unbalanced <= _TOLERANCE * forces),
    }
    return [name for name, holds in conditions.items() if not holds]


_MAX_ITERATIONS = 30
_CONVERGED = 1e-12
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
        if iteration and np.all(np.abs(error) <= _CONVERGED * scales(problem, unknowns)):
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
