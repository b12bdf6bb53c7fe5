"""Signorini's conditions with given loads, on the condensed interface.

Find λ and the rigid motion d of the holder with

    r = A λ + g - R d >= 0,   λ >= 0,   λ·r = 0,   Rᵀ λ = F.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import ComputationError
from .lemke import lemke

_TOLERANCE = 1e-9
_ADVICE = (
    "with friction heat this happens beyond the critical sliding speed (thermoelastic "
    "instability): reduce the speed, or the expansion, or the friction"
)


@dataclass(frozen=True)
class ContactSolution:
    """Coefficients of the pressure, rigid motion of the holder, and which coefficients press.

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
) -> ContactSolution:
    """Solve by a primal-dual active set, and by Lemke's method where that runs in circles.

    Parameters
    ----------
    compliance : ndarray, shape (m, m)
        A; symmetric or not (friction, friction heat).
    gap : ndarray, shape (m,)
        g.
    modes : ndarray, shape (m, k)
        R.
    load : ndarray, shape (k,)
        F.
    start : ndarray of bool, shape (m,), optional
        Coefficients that are expected to press.

    Returns
    -------
    ContactSolution
        Checked: every inequality holds for every coefficient to 1e-9 of its scale.

    Raises
    ------
    ComputationError
        If there is no solution.
    """
    everywhere = np.ones(len(gap), dtype=bool)
    for active in (everywhere,) if start is None else (start, everywhere):
        solution = _active_set(compliance, gap, modes, load, active)
        if solution is not None:
            return _checked(compliance, gap, modes, load, solution)
    active = _pressing_by_lemke(compliance, gap, modes, load)
    solution = _with_active(compliance, gap, modes, load, active)
    if solution is None:
        raise ComputationError("contact: the load cannot be carried by the contact zone")
    return _checked(compliance, gap, modes, load, solution)


def _active_set(compliance, gap, modes, load, active) -> ContactSolution | None:
    """Primal-dual active set from a first guess; None where it runs in circles or dry."""
    seen = set()
    while active.tobytes() not in seen:
        seen.add(active.tobytes())
        solution = _with_active(compliance, gap, modes, load, active)
        if solution is None:
            return None
        following = _pressing(compliance, gap, modes, solution)
        if np.array_equal(following, active):
            return solution
        active = following if following.any() else active | (gap <= gap.min())
    return None


def _with_active(compliance, gap, modes, load, active) -> ContactSolution | None:
    """The linear problem with closed contact at the active coefficients, none where singular."""
    count, k = int(active.sum()), modes.shape[1]
    if count < k:
        return None
    size = np.sqrt(np.abs(np.diag(compliance)[active]))
    stretch = np.abs(modes[active] / size[:, None]).max()
    border = modes[active] / size[:, None] / stretch
    matrix = np.zeros((count + k, count + k))
    matrix[:count, :count] = compliance[np.ix_(active, active)] / np.outer(size, size)
    matrix[:count, count:] = -border
    matrix[count:, :count] = -border.T
    right = np.concatenate([-gap[active] / size, -load / stretch])
    try:
        unknowns = np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        return None
    coefficients = np.zeros(len(gap))
    coefficients[active] = unknowns[:count] / size
    return ContactSolution(coefficients, unknowns[count:] / stretch, active)


def _pressing(compliance, gap, modes, solution: ContactSolution) -> np.ndarray:
    """Which coefficients should press next: those that do, and those that penetrate."""
    residual = compliance @ solution.coefficients + gap - modes @ solution.motion
    scales = _scales(compliance, gap, solution)
    presses = solution.active & (solution.coefficients > -_TOLERANCE * scales[0])
    return presses | (~solution.active & (residual < -_TOLERANCE * scales[1]))


def _scales(compliance, gap, solution: ContactSolution) -> tuple[np.ndarray, np.ndarray]:
    """Sizes that errors of each coefficient and weak gap are measured against."""
    largest = np.abs(solution.coefficients).max()
    row = np.abs(compliance) @ np.abs(solution.coefficients) + np.abs(gap)
    return np.full(len(gap), largest), row


def _checked(compliance, gap, modes, load, solution: ContactSolution) -> ContactSolution:
    λ = solution.coefficients
    residual = compliance @ λ + gap - modes @ solution.motion
    force_scale, gap_scale = _scales(compliance, gap, solution)
    carried = np.abs(modes).T @ np.abs(λ)
    wrong = (
        np.any(λ < -_TOLERANCE * force_scale)
        or np.any(residual < -_TOLERANCE * gap_scale)
        or np.any(np.abs(residual[solution.active]) > _TOLERANCE * gap_scale[solution.active])
        or np.any(np.abs(modes.T @ λ - load) > _TOLERANCE * (carried + np.abs(load)))
    )
    if wrong or not np.all(np.isfinite(λ)):
        raise ComputationError(
            f"contact: no pressure satisfies the contact conditions at this load; {_ADVICE}"
        )
    return ContactSolution(np.maximum(λ, 0.0), solution.motion, solution.active)


def _pressing_by_lemke(compliance, gap, modes, load) -> np.ndarray:
    """The active set by Lemke's method; the rigid motion is a difference of two positives."""
    m, k = modes.shape
    size = 1 / np.sqrt(np.abs(np.diag(compliance)))
    # orthonormal modes: given ones may be nearly parallel (a tilt about a far pivot)
    border, mixing = np.linalg.qr(modes * size[:, None])
    force = np.linalg.solve(mixing.T, load)
    matrix = np.zeros((m + 2 * k, m + 2 * k))
    matrix[:m, :m] = compliance * np.outer(size, size)
    matrix[:m, m:] = np.hstack([-border, border])
    matrix[m:, :m] = np.vstack([border.T, -border.T])
    right = np.concatenate([gap * size, -force, force])
    solution = lemke(matrix, right / np.abs(right).max())
    if solution is None:
        raise ComputationError(f"contact: no equilibrium found; {_ADVICE}")
    return solution[:m] > 1e-12 * solution[:m].max()
