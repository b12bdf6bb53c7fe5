"""Motion of a holder at which worn faces conform with the least wear volume."""

from __future__ import annotations

import numpy as np
import scipy

_TOLERANCE = 1e-10
"""Feasibility of linear programs, relative to the largest change of the gap; the least of HiGHS."""
_SLACK = 1e-11
"""Depth by which other motions of least volume may add material, relative to the same change."""
_SAME = 1e-6
"""Difference of depths below which there is one motion of least volume, as `_SLACK` allows it."""


def least_worn(
    modes: np.ndarray, opening: np.ndarray, weights: np.ndarray, pressing: np.ndarray
) -> np.ndarray:
    """Motion of the holder at which the faces conform with the least wear volume.

    The wear depth is ``R d - B u``, non-negative at all points in contact. For a single translation
    of a flat face the highest point is then just unworn. Where many motions wear as little, as
    tilts of a symmetric face, the one of least squares of the depth is taken, which is unique: a
    symmetric face stays symmetric. Likewise where every motion would need material to be added, as
    of a body between two others.

    Parameters
    ----------
    modes : ndarray, shape (n, k)
        R of the free motions.
    opening : ndarray, shape (n,)
        ``B u``, change of the gap by load and heat [m].
    weights : ndarray, shape (n,) [m²]
    pressing : ndarray of bool, shape (n,)

    Returns
    -------
    ndarray, shape (k,)
    """
    R, size = modes[pressing], np.abs(opening).max() or 1.0
    stretch = np.abs(R).max(axis=0)
    R, gap, weights = R / stretch, opening[pressing] / size, weights[pressing] / weights.sum()
    volume = weights @ R
    found = scipy.optimize.linprog(
        volume / np.abs(volume).max(),
        A_ub=-R,
        b_ub=-gap,
        bounds=(None, None),
        options={
            "primal_feasibility_tolerance": _TOLERANCE,
            "dual_feasibility_tolerance": _TOLERANCE,
        },
    ).x
    if found is None:
        roots = np.sqrt(weights)
        found = np.linalg.lstsq(R * roots[:, None], gap * roots, rcond=None)[0]
        return found / stretch * size
    return _fitted(R, gap, weights, found) / stretch * size


def _fitted(R: np.ndarray, gap: np.ndarray, weights: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Motion of least squares among those with the volume of one; that one if there is no other."""
    free = np.linalg.svd((weights @ R)[None])[2][1:].T  # changes that leave the volume as it is
    rows, missing = R @ free, gap - R @ motion
    if rows.size == 0 or np.linalg.matrix_rank(rows) < rows.shape[1]:
        return motion
    bounds, root = np.minimum(missing, 0.0) - _SLACK, np.sqrt(weights)
    try:
        shift = _constrained_fit(root[:, None] * rows, root * missing, rows, bounds)
    except RuntimeError:  # of nnls, without convergence
        return motion
    change = rows @ shift
    feasible = np.all(change >= bounds - _SLACK)
    return motion + free @ shift if feasible and np.abs(change).max() > _SAME else motion


def _constrained_fit(
    A: np.ndarray, b: np.ndarray, rows: np.ndarray, bounds: np.ndarray
) -> np.ndarray:
    """Least squares of ``A x - b`` with ``rows @ x >= bounds``.

    Problem LSI of Lawson and Hanson, Solving Least Squares Problems, chapter 23: reduced to the
    least distance, whose dual has non-negative unknowns only.
    """
    Q, R = np.linalg.qr(A)
    middle = np.linalg.solve(R, Q.T @ b)
    reduced = np.linalg.solve(R.T, rows.T)
    aim = np.zeros(len(R) + 1)
    aim[-1] = 1.0
    dual = np.vstack((reduced, bounds - rows @ middle))
    residual = dual @ scipy.optimize.nnls(dual, aim)[0] - aim
    with np.errstate(
        divide="ignore", invalid="ignore"
    ):  # no x is feasible: the result is not finite
        return middle - np.linalg.solve(R, residual[:-1] / residual[-1])
