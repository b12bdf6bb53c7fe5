"""Contact problems coupled by shared worn depths, by fixed-point iteration (Anderson).

For each position j find λ_j, the rigid motion d_j of the holder, and for all of them the depths y:

    r_j = A_j λ_j + g_j + S_j y - R_j d_j >= 0,   λ_j >= 0,   λ_j·r_j = 0,   T_jᵀ λ_j = F,
    y = y_0 + Σ_j G_j λ_j.

An implicit wear step has this form. For given active sets it decouples into small problems and a
system for y. Stacked it is one large Signorini problem with full coupling (see `signorini`), used
as the fallback.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.linalg import block_diag

from ...serialise import serialisable
from .signorini import active_set, saddle_point, solve_contact


class AndersonMixing:
    """Anderson mixing of the last iterates, without damping.

    Walker and Ni, SIAM J. Numer. Anal. 49 (2011) 1715.

    Parameters
    ----------
    remembered : int
        Number of iterates.
    """

    def __init__(self, remembered: int = 6) -> None:
        self._remembered = remembered
        self._iterates: list[np.ndarray] = []
        self._residuals: list[np.ndarray] = []

    def next(self, iterate: np.ndarray, residual: np.ndarray) -> np.ndarray:
        """Next iterate from the present one and its residual (image minus iterate), shape (k,)."""
        self._iterates = [*self._iterates, iterate][-self._remembered :]
        self._residuals = [*self._residuals, residual][-self._remembered :]
        if len(self._iterates) == 1:
            return iterate + residual
        Δx, Δr = np.diff(self._iterates, axis=0).T, np.diff(self._residuals, axis=0).T
        weights = np.linalg.lstsq(Δr, residual, rcond=1e-12)[0]
        return iterate + residual - (Δx + Δr) @ weights


_TOLERANCE = 1e-9


@dataclass(frozen=True)
class CoupledContacts:
    """J contacts with m coefficients and k free motions each, and N depths.

    Attributes
    ----------
    compliance : ndarray, shape (J, m, m)
        Compliances A, symmetric or not.
    gap : ndarray, shape (J, m)
        Weak gaps g.
    gap_per_depth : ndarray, shape (J, m, N)
        Weak gap S per worn depth.
    modes, force_modes : ndarray, shape (J, m, k)
        R and T.
    load : ndarray, shape (k,)
        Load F.
    """

    compliance: np.ndarray
    gap: np.ndarray
    gap_per_depth: np.ndarray
    modes: np.ndarray
    force_modes: np.ndarray
    load: np.ndarray


@serialisable
@dataclass(frozen=True)
class CoupledSolution:
    """Coefficients, motions, active sets, and the worn depths.

    Attributes
    ----------
    coefficients : ndarray, shape (J, m)
    motion : ndarray, shape (J, k)
    active : ndarray of bool, shape (J, m)
    depths : ndarray, shape (N,)
    """

    coefficients: np.ndarray
    motion: np.ndarray
    active: np.ndarray
    depths: np.ndarray


def solve_coupled(
    contacts: CoupledContacts, start: np.ndarray, gains: np.ndarray, active: np.ndarray
) -> CoupledSolution:
    """Solve by a primal-dual active set on all contacts at once, stacked if that fails.

    Parameters
    ----------
    contacts : CoupledContacts
    start : ndarray, shape (N,)
        Initial depths y_0.
    gains : ndarray, shape (J, N, m)
        Worn depth G per coefficient.
    active : ndarray of bool, shape (J, m)
        Predicted active coefficients.

    Raises
    ------
    ComputationError
        If there is no solution.
    """
    solve = partial(_with_active, contacts, start, gains)
    solution = active_set(active, solve, partial(_pressing, contacts))
    return _stacked(contacts, start, gains, active) if solution is None else solution


def _stacked(
    contacts: CoupledContacts, start: np.ndarray, gains: np.ndarray, active: np.ndarray
) -> CoupledSolution:
    """Solution of all contacts as one stacked Signorini problem."""
    count, m, k = contacts.modes.shape
    gap_per_depth = contacts.gap_per_depth.reshape(count * m, -1)
    compliance = block_diag(*contacts.compliance)
    compliance = compliance + gap_per_depth @ gains.transpose(1, 0, 2).reshape(len(start), -1)
    solution = solve_contact(
        compliance,
        contacts.gap.ravel() + gap_per_depth @ start,
        block_diag(*contacts.modes),
        np.tile(contacts.load, count),
        active.ravel(),
        block_diag(*contacts.force_modes),
    )
    λ = solution.coefficients.reshape(count, m)
    depths = start + np.einsum("jnm,jm->n", gains, λ)
    return CoupledSolution(λ, solution.motion.reshape(count, k), λ > 0, depths)


def _with_active(
    contacts: CoupledContacts, start: np.ndarray, gains: np.ndarray, active: np.ndarray
) -> CoupledSolution | None:
    """Solution with closed contact at the active coefficients; None if underconstrained."""
    if np.any(active.sum(axis=1) < len(contacts.load)):
        return None
    eliminated = _eliminated(contacts, active)
    if eliminated is None:
        return None
    m, at_zero_depth, per_depth = active.shape[1], eliminated[..., 0], eliminated[..., 1:]
    spread = np.eye(len(start)) - np.tensordot(gains, per_depth[:, :m], axes=((0, 2), (0, 1)))
    depths = np.linalg.solve(spread, start + np.einsum("jnm,jm->n", gains, at_zero_depth[:, :m]))
    unknowns = at_zero_depth + per_depth @ depths
    return CoupledSolution(unknowns[:, :m], unknowns[:, m:], active, depths)


def _eliminated(contacts: CoupledContacts, active: np.ndarray) -> np.ndarray | None:
    """λ and d at zero depths, then their derivatives by the depths, shape (J, m + k, 1 + N)."""
    count, m, k = contacts.modes.shape
    pressed = active[..., None]
    both = pressed & active[:, None] | np.eye(m, dtype=bool)
    gap = np.concatenate([contacts.gap[..., None], contacts.gap_per_depth], axis=2)
    load = np.zeros((count, k, gap.shape[2]))
    load[..., 0] = contacts.load
    modes, force_modes, gap = (
        np.where(pressed, part, 0.0) for part in (contacts.modes, contacts.force_modes, gap)
    )
    compliance = np.where(both, contacts.compliance, 0.0)
    return saddle_point(compliance, modes, force_modes, gap, load)


def _pressing(contacts: CoupledContacts, solution: CoupledSolution) -> np.ndarray:
    """Next active sets: active coefficients under pressure, and penetrating ones."""
    λ, y = solution.coefficients, solution.depths
    elastic, worn = np.einsum("jmn,jn->jm", contacts.compliance, λ), contacts.gap_per_depth @ y
    closing = np.einsum("jmk,jk->jm", contacts.modes, solution.motion)
    residual = elastic + contacts.gap + worn - closing
    scale = sum(np.abs(part) for part in (elastic, contacts.gap, worn, closing))
    presses = solution.active & (λ > -_TOLERANCE * np.abs(λ).max(axis=1, keepdims=True))
    return presses | (~solution.active & (residual < -_TOLERANCE * scale))
