"""Lemke's method for linear complementarity problems."""

from __future__ import annotations

import numpy as np


def lemke(matrix: np.ndarray, right: np.ndarray) -> np.ndarray | None:
    """Solve ``w = M z + q >= 0, z >= 0, z·w = 0``.

    Complementary pivoting with the lexicographic rule, which excludes cycling. It finds a solution
    if M is copositive-plus and one exists (Cottle, Pang and Stone, The Linear Complementarity
    Problem, 1992, section 4.4).

    Parameters
    ----------
    matrix : ndarray, shape (n, n)
        Matrix M.
    right : ndarray, shape (n,)
        Vector q.

    Returns
    -------
    ndarray or None
        Solution z; None if the method ends on a secondary ray.
    """
    n = len(right)
    if np.all(right >= 0):
        return np.zeros(n)
    # columns: w (n), z (n), the covering variable, the right-hand side
    tableau = np.hstack([np.eye(n), -matrix, -np.ones((n, 1)), right[:, None]])
    basis = np.arange(n)
    entering, cover = 2 * n, 2 * n
    row = int(np.lexsort(np.hstack([-np.eye(n), right[:, None]]).T)[0])
    for _ in range(50 * n + 100):
        leaving = basis[row]
        tableau[row] /= tableau[row, entering]
        others = np.arange(n) != row
        tableau[others] -= np.outer(tableau[others, entering], tableau[row])
        basis[row] = entering
        if leaving == cover:
            values = np.zeros(2 * n + 1)
            values[basis] = tableau[:, -1]
            return values[n : 2 * n]
        entering = leaving + n if leaving < n else leaving - n
        found = _leaving_row(tableau, basis, entering, n, cover)
        if found is None:
            return None
        row = found
    return None


def _leaving_row(tableau, basis, entering: int, n: int, cover: int) -> int | None:
    """Row of the smallest ratio; ties broken lexicographically by rows of the inverse basis."""
    column = tableau[:, entering]
    rows = np.flatnonzero(column > 1e-11)
    if len(rows) == 0:
        return None
    ratio = tableau[rows, -1] / column[rows]
    rows = rows[ratio <= ratio.min() + 1e-13 * max(1.0, abs(ratio.min()))]
    if len(rows) == 0:  # the numbers have overflowed
        return None
    if len(rows) == 1:
        return int(rows[0])
    out = rows[basis[rows] == cover]
    if len(out):
        return int(out[0])
    keys = tableau[rows, :n] / column[rows, None]
    return int(rows[np.lexsort(keys.T[::-1])[0]])


def with_motion(
    compliance: np.ndarray,
    modes: np.ndarray,
    force_modes: np.ndarray,
    gap: np.ndarray,
    load: np.ndarray,
) -> np.ndarray | None:
    """Coefficients λ (m,) of contact with a rigid motion of the holder, see `signorini`; scaled.

    The motion is a difference of nonnegative variables. None if there is no solution.
    """
    m, k = modes.shape
    size = 1 / np.sqrt(np.abs(np.diag(compliance)))
    # orthonormal modes: given ones may be nearly parallel (tilt about a far pivot)
    border, _ = np.linalg.qr(modes * size[:, None])
    rows, mixing = np.linalg.qr(force_modes * size[:, None])
    force = np.linalg.solve(mixing.T, load)
    matrix = np.zeros((m + 2 * k, m + 2 * k))
    matrix[:m, :m] = compliance * np.outer(size, size)
    matrix[:m, m:] = np.hstack([-border, border])
    matrix[m:, :m] = np.vstack([rows.T, -rows.T])
    right = np.concatenate([gap * size, -force, force])
    solution = lemke(matrix, right / np.abs(right).max())
    return None if solution is None else solution[:m]
