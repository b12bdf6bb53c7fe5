"""Motion of a holder at which worn faces conform with the least wear volume."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog, nnls

_TOLERANCE = 1e-10
"""Feasibility of linear programs, relative to the largest change of the gap; the least of HiGHS."""
_SLACK = 1e-12
"""Wear depth and volume by which other motions of least volume may differ, above rounding."""
_SAME = 1e-6
"""Difference of motions below which there is only one of least volume, as `_SLACK` allows it."""


def least_worn(
    modes: np.ndarray, opening: np.ndarray, weights: np.ndarray, pressing: np.ndarray
) -> np.ndarray:
    """Motion of the holder at which the faces conform with the least wear volume.

    The wear depth is ``R d - B u``, non-negative at all points in contact. For a single translation
    of a flat face the highest point is then just unworn. Where many motions wear as little, as
    tilts of a symmetric face, the one of least squares of the depth is taken, which is unique: a
    symmetric face stays symmetric.

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
    found = linprog(
        volume / np.abs(volume).max(),
        A_ub=-R,
        b_ub=-gap,
        bounds=(None, None),
        options={
            "primal_feasibility_tolerance": _TOLERANCE,
            "dual_feasibility_tolerance": _TOLERANCE,
        },
    ).x
    rows = np.vstack((R, -volume))
    bounds = (
        np.minimum(np.append(gap, np.inf), rows @ found) - _SLACK
    )  # so that `found` is feasible
    root = np.sqrt(weights)
    fitted = _constrained_fit(root[:, None] * R, root * gap, rows, bounds)
    unique = np.abs(fitted - found).max() < _SAME
    return (found if unique else fitted) / stretch * size


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
    residual = dual @ nnls(dual, aim)[0] - aim
    return middle - np.linalg.solve(R, residual[:-1] / residual[-1])
