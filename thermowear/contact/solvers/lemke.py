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
    if len(rows) == 1:
        return int(rows[0])
    out = rows[basis[rows] == cover]
    if len(out):
        return int(out[0])
    keys = tableau[rows, :n] / column[rows, None]
    return int(rows[np.lexsort(keys.T[::-1])[0]])
