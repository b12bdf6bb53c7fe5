"""Signorini contact with given loads on the condensed interface.

Find λ and the rigid motion d of the holder with

    r = A λ + g - R d >= 0,   λ >= 0,   λ·r = 0,   Tᵀ λ = F.

Without friction in the section T = R.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeVar

import numpy as np
import scipy.linalg
from scipy.linalg.lapack import dgetrf, dgetrs

from ...errors import ComputationError
from ...serialise import serialisable
from .lemke import with_motion

_TOLERANCE = 1e-9
_MAX_SETS = 1000
"""Largest number of active sets tried; a few tens suffice unless the compliance is singular."""
_MAX_PIVOTS, _WORK = 300, 1e11
"""Largest number of sets tried after one has returned; about the number of products that they may
cost, though 30 are tried."""
_FREE = 1e-10
"""Part of a motion, relative to the largest displacements, that counts as rounding."""
_BLOCKS = 10
"""Number of changes of several coefficients at once after which fewer must be wrong."""
Solution = TypeVar("Solution")


class NoEquilibrium(ComputationError):
    """Error: no pressure satisfies Signorini's conditions and carries the load."""


@serialisable
@dataclass(frozen=True)
class SignoriniSolution:
    """Coefficients of the pressure, rigid motion of the holder, and active set.

    Attributes
    ----------
    coefficients : ndarray, shape (m,)
    motion : ndarray, shape (k,)
    active : ndarray of bool, shape (m,)
    """

    coefficients: np.ndarray
    motion: np.ndarray
    active: np.ndarray


def solve_contact(
    compliance: np.ndarray,
    gap: np.ndarray,
    modes: np.ndarray,
    load: np.ndarray,
    start: np.ndarray | None = None,
    force_modes: np.ndarray | None = None,
    factors: SaddleFactors | None = None,
) -> SignoriniSolution:
    """Solve by a primal-dual active set, and by Lemke's method if that cycles.

    Parameters
    ----------
    compliance : ndarray, shape (m, m)
        Compliance A, symmetric or not (friction, friction heat).
    gap : ndarray, shape (m,)
        Weak gap g.
    modes : ndarray, shape (m, k)
        R; k = 0 if the holder has no free motion.
    load : ndarray, shape (k,)
        Load F.
    start : ndarray of bool, shape (m,), optional
        Predicted active coefficients.
    force_modes : ndarray, shape (m, k), optional
        T, by default R.
    factors : SaddleFactors, optional
        Factors of earlier problems, reused for the same arrays A, R and T.

    Returns
    -------
    SignoriniSolution
        Verified: every inequality holds for every coefficient to 1e-9 of its scale.

    Raises
    ------
    NoEquilibrium
        If there is no solution. Possible causes in the compliance: self-locking by friction, or
        friction heat beyond the critical speed.
    """
    # relative to nearly closed faces: a far start would lose the digits of the deflection
    origin = np.linalg.lstsq(modes, gap, rcond=None)[0]
    forces = modes if force_modes is None else force_modes
    problem = _Problem(compliance, gap - modes @ origin, modes, load, forces, factors)
    solution = _solve(problem, start)
    return replace(solution, motion=solution.motion + origin)


def _solve(problem: _Problem, start: np.ndarray | None) -> SignoriniSolution:
    """Active-set method from the predicted set and from full contact, then Lemke's method."""
    everywhere = np.ones(len(problem.gap), dtype=bool)
    starts = (everywhere,) if start is None else (start, everywhere)
    solve, pressing = partial(_with_active, problem), partial(_pressing, problem)
    for pivoting in (False, True):
        if pivoting and not _is_monotone(problem):
            break  # beyond a critical speed it might end in an unstable state
        for active in starts:
            solution = active_set(active, solve, pressing, pivoting)
            if solution is not None:
                return _verified(problem, solution)
    solution = _with_active(problem, _pressing_by_lemke(problem))
    if solution is None:
        raise NoEquilibrium("contact: the load cannot be carried by the contact zone")
    return _verified(problem, solution)


def _is_monotone(problem: _Problem) -> bool:
    """Whether the compliance is positive for pressures without resultant."""
    A, modes = problem.compliance, problem.modes
    size = np.sqrt(np.abs(np.diagonal(A)))
    held = modes.shape[1] == 0
    free = np.eye(len(A)) if held else scipy.linalg.null_space((modes / size[:, None]).T)
    scaled = free.T @ (A / np.outer(size, size)) @ free
    return bool(np.linalg.eigvalsh(scaled + scaled.T)[:1].min(initial=1.0) > 0.0)


@dataclass(frozen=True)
class _Problem:
    """Data A, g, R, F and T of the problem in the module's docstring."""

    compliance: np.ndarray
    gap: np.ndarray
    modes: np.ndarray
    load: np.ndarray
    force_modes: np.ndarray
    factors: SaddleFactors | None = None

    def residual(self, solution: SignoriniSolution) -> np.ndarray:
        return self.compliance @ solution.coefficients + self.gap - self.modes @ solution.motion

    def scales(self, solution: SignoriniSolution) -> tuple[np.ndarray, np.ndarray]:
        """Reference magnitudes of the errors of each coefficient and weak gap."""
        λ = np.abs(solution.coefficients)
        return np.full(len(λ), λ.max()), np.abs(self.compliance) @ λ + np.abs(self.gap)


def active_set(
    active: np.ndarray,
    solve: Callable[[np.ndarray], Solution | None],
    pressing: Callable[[Solution], np.ndarray],
    pivoting: bool = False,
) -> Solution | None:
    """Primal-dual active set from a first guess; None if it cycles or becomes singular.

    If a set returns, and with `pivoting`, it goes on with single pivots as long as the number of
    wrong coefficients does not decrease, which ends for every P-matrix (J.J. Júdice and F.M. Pires,
    Comput. Oper. Res. 21 (1994) 587).

    Parameters
    ----------
    active : ndarray of bool
    solve : callable
        Solution with closed contact at the active coefficients; None if singular.
    pressing : callable
        Next active set of a solution.
    pivoting : bool, optional
    """
    tried: set[bytes] = set()
    fewest, blocks, pivots = len(active) + 1, _BLOCKS, 0
    most = int(np.clip(_WORK / max(len(active), 1) ** 3, 30, _MAX_PIVOTS))
    while len(tried) < _MAX_SETS and pivots < most:
        solution = solve(active)
        if solution is None:
            return None
        before, active = active, pressing(solution)
        wrong = np.flatnonzero(active != before)
        if not len(wrong):
            return solution
        if not pivots and before.tobytes() not in tried:
            tried.add(before.tobytes())
            continue
        if not pivoting:
            return None
        fewest, blocks = (len(wrong), _BLOCKS) if len(wrong) < fewest else (fewest, blocks - 1)
        pivots += 1
        if blocks < 0:
            active = before.copy()
            active[wrong[-1]] = not before[wrong[-1]]
    return None


def _with_active(problem: _Problem, active: np.ndarray) -> SignoriniSolution | None:
    """Solution with closed contact at the active coefficients; None if singular."""
    count = int(active.sum())
    if not count and len(problem.load):
        return None
    matrices = problem.compliance, problem.modes, problem.force_modes
    factor = (problem.factors or SaddleFactors(0)).of(active, *matrices)
    found = None if factor is None else factor.solve(problem.gap[active], problem.load)
    if found is None:
        return None
    coefficients = np.zeros(len(problem.gap))
    coefficients[active] = found[:count]
    return SignoriniSolution(coefficients, found[count:], active)


class SaddlePoint:
    """Factorised problem ``A λ - R d = -g, Tᵀ λ = F`` of the active coefficients.

    Motions that these do not resist, as of a pad that touches at one function right below its
    pivot, are not determined: the least one is chosen, and a load along them has no solution.

    Parameters
    ----------
    compliance : ndarray, shape (m, m)
    modes, force_modes : ndarray, shape (m, k)
    active : ndarray of bool, shape (m,)
    """

    def __init__(
        self,
        compliance: np.ndarray,
        modes: np.ndarray,
        force_modes: np.ndarray,
        active: np.ndarray,
    ):
        reduced = compliance if active.all() else compliance[np.ix_(active, active)]
        self._moved, _ = resisted(modes, active)
        self._carried, self._not_carried = resisted(force_modes, active)
        self.singular = int(self._moved.shape != self._carried.shape)
        if self.singular:
            return
        borders = modes[active] @ self._moved, force_modes[active] @ self._carried
        matrix, self._scale = _scaled_matrix(reduced, *borders)
        if matrix.size:  # nothing presses, and nothing moves
            matrix = np.asfortranarray(matrix)
            self._factor, self._pivots, self.singular = dgetrf(matrix, overwrite_a=1)

    def solve(self, gap: np.ndarray, load: np.ndarray) -> np.ndarray | None:
        """λ, then d, for one gap (m,) and load (k,); None if no pressure carries the load."""
        carried, other = self._carried.T @ load, np.linalg.norm(self._not_carried.T @ load)
        if other > _FREE * np.linalg.norm(carried):
            return None
        right, scale = -np.concatenate([gap, carried]), self._scale[:, 0]
        if right.size:
            right = dgetrs(self._factor, self._pivots, right / scale)[0].ravel() / scale
        return np.concatenate([right[: len(gap)], self._moved @ right[len(gap) :]])


def resisted(modes: np.ndarray, active: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Motions (k, r) that displace active coefficients, all that span them, and others (k, k - r).

    Orthogonal in units of the largest displacements of each mode.
    """
    unit = np.abs(modes).max(axis=0, initial=0.0)
    unit[unit == 0.0] = 1.0
    rows = modes[active] / unit
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    rows = np.divide(rows, lengths, out=np.zeros_like(rows), where=lengths > 0.0)
    padded = np.vstack([rows, np.zeros((len(unit),) * 2)])  # all motions, of few rows too
    _, sizes, motions = np.linalg.svd(padded, full_matrices=False)
    rank = int((sizes > _FREE * sizes.max(initial=0.0)).sum())
    if rank == len(unit):
        return np.eye(rank), np.zeros((rank, 0))
    each = motions.T / unit[:, None]
    return each[:, :rank], each[:, rank:]


class SaddleFactors:
    """Factors of a number of last problems, by compliance, modes and active set."""

    def __init__(self, kept: int):
        self._kept = kept
        self._known: list[tuple[tuple, np.ndarray, SaddlePoint]] = []

    def of(self, active: np.ndarray, *matrices: np.ndarray) -> SaddlePoint | None:
        """Factor for the active coefficients of given matrices A, R and T; None if singular."""
        for known, chosen, factor in self._known:
            same = all(one is two for one, two in zip(known, matrices, strict=True))
            if same and np.array_equal(chosen, active):
                return factor
        compliance, modes, force_modes = matrices
        factor = SaddlePoint(compliance, modes, force_modes, active)
        if factor.singular:
            return None
        if self._kept:
            self._known = [*self._known[1 - self._kept :], (matrices, active, factor)]
        return factor


def saddle_point(
    compliance: np.ndarray,
    modes: np.ndarray,
    force_modes: np.ndarray,
    gap: np.ndarray,
    load: np.ndarray,
) -> np.ndarray | None:
    """Solve ``A λ - R d = -g, Tᵀ λ = F``, scaled by the diagonal of A; None if singular.

    Parameters
    ----------
    compliance : ndarray, shape (..., m, m)
    modes, force_modes : ndarray, shape (..., m, k)
    gap : ndarray, shape (..., m, r)
        For r right-hand sides.
    load : ndarray, shape (..., k, r)

    Returns
    -------
    ndarray, shape (..., m + k, r)
        λ, then d.
    """
    matrix, scale = _scaled_matrix(compliance, modes, force_modes)
    try:
        return np.linalg.solve(matrix, -np.concatenate([gap, load], axis=-2) / scale) / scale
    except np.linalg.LinAlgError:
        return None


def _scaled_matrix(
    compliance: np.ndarray, modes: np.ndarray, force_modes: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Scaled matrix (..., m + k, m + k) of a saddle-point problem, with its scales (.., 1)."""
    m, k = modes.shape[-2:]
    size = np.sqrt(np.abs(np.diagonal(compliance, axis1=-2, axis2=-1)))[..., None]
    border, rows = modes / size, force_modes / size
    stretch = np.abs(border).max(axis=-2, keepdims=True, initial=0.0)
    stretch[stretch == 0.0] = 1.0
    matrix = np.zeros((*modes.shape[:-2], m + k, m + k))
    matrix[..., :m, :m] = compliance / size / size.mT
    matrix[..., :m, m:] = -border / stretch
    matrix[..., m:, :m] = -(rows / stretch).mT
    return matrix, np.concatenate([size, stretch.mT], axis=-2)


def _pressing(problem: _Problem, solution: SignoriniSolution) -> np.ndarray:
    """Next active set: active coefficients under pressure, and penetrating ones."""
    residual = problem.residual(solution)
    scales = problem.scales(solution)
    presses = solution.active & (solution.coefficients > -_TOLERANCE * scales[0])
    presses |= ~solution.active & (residual < -_TOLERANCE * scales[1])
    nearest = ~solution.active & (problem.gap <= problem.gap.min())
    # where no coefficient presses, a load needs more of them; if there are none, the set is empty
    lost = len(problem.load) > 0 and not presses.any() and nearest.any()
    return solution.active | nearest if lost else presses


def _verified(problem: _Problem, solution: SignoriniSolution) -> SignoriniSolution:
    λ = solution.coefficients
    residual = problem.residual(solution)
    force_scale, gap_scale = problem.scales(solution)
    forces = np.abs(problem.force_modes)
    carried = forces.T @ np.abs(λ)
    arms = _FREE * forces.max(axis=0) * force_scale[0]  # right below a pivot they are rounding
    unbalanced = np.abs(problem.force_modes.T @ λ - problem.load)
    wrong = (
        np.any(λ < -_TOLERANCE * force_scale)
        or np.any(residual < -_TOLERANCE * gap_scale)
        or np.any(np.abs(residual[solution.active]) > _TOLERANCE * gap_scale[solution.active])
        or np.any(unbalanced > _TOLERANCE * (carried + np.abs(problem.load)) + arms)
    )
    if wrong or not np.all(np.isfinite(λ)):
        raise NoEquilibrium("contact: no pressure satisfies the contact conditions at this load")
    return SignoriniSolution(np.maximum(λ, 0.0), solution.motion, solution.active)


def _pressing_by_lemke(problem: _Problem) -> np.ndarray:
    """Active set by Lemke's method."""
    matrices = problem.compliance, problem.modes, problem.force_modes
    coefficients = with_motion(*matrices, problem.gap, problem.load)
    if coefficients is None:
        raise NoEquilibrium("contact: no equilibrium found")
    return coefficients > 1e-12 * coefficients.max()


_REAL = 1e-9
"""Imaginary part, relative to the eigenvalue, below which a mode does not swing."""


def critical_factor(
    compliance: np.ndarray, thermal: np.ndarray, modes: np.ndarray, active: np.ndarray
) -> float:
    """Least part of its friction heat by which a pressure of a contact zone maintains itself.

    With the compliance A and the thermal distortion H by the heat of the pressure, a pressure
    without resultant that keeps the faces closed under a part s of the heat satisfies
    ``(A + s H) λ = R d``. The least s > 0 is the critical speed factor of static modes
    (R. A. Burton et al., Wear 24 (1973) 177), infinite without any; the state is unstable if it
    is less than 1.

    Parameters
    ----------
    compliance, thermal : ndarray, shape (m, m)
        A and H.
    modes : ndarray, shape (m, k)
        Rigid-body modes R of the holder.
    active : ndarray of bool, shape (m,)
        Coefficients in contact.
    """
    free = scipy.linalg.null_space(modes[active].T) if modes.shape[1] else np.eye(active.sum())
    if not free.shape[1]:
        return np.inf
    elastic, hot = (free.T @ each[np.ix_(active, active)] @ free for each in (compliance, thermal))
    values = scipy.linalg.eigvals(np.linalg.solve(elastic, hot))
    static = values.real[np.abs(values.imag) <= _REAL * np.abs(values)]
    least = static.min(initial=0.0)
    return -1 / float(least) if least < 0.0 else np.inf
