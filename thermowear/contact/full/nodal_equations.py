"""Common parts of equations on all nodal displacements, bordered by motions of holders."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from ...bulk.direct_solver import multiply
from ...bulk.field import without_fixed
from ...bulk.group_solvers import AnyFactor
from ...bulk.mechanics.elasticity import Elasticity
from ...parallel import sum_over_ranks

_SINGULAR = 1e12
"""Condition number of the border from which a motion is not constrained."""


class NodalEquations:
    """Equilibrium of elastic bodies at their nodes; collective calls."""

    def __init__(self, elastic: Elasticity):
        self.elastic = elastic

    def elastic_forces(self, displacement: np.ndarray) -> np.ndarray:
        """Elastic nodal forces K u, zero at supported degrees of freedom."""
        return without_fixed(multiply(self.elastic.stiffness, displacement), self.elastic.fixed)

    def _sum(self, values):
        return sum_over_ranks(self.elastic.bodies.comm, values)

    def _largest(self, *arrays: np.ndarray) -> float:
        largest = np.max([np.abs(array).max(initial=0.0) for array in arrays])
        return float(np.max(self.elastic.bodies.comm.allgather(largest)))


def held(elastic: Elasticity, matrix: sp.csr_matrix) -> sp.csr_matrix:
    """Transposed trace without supported rows and without rounding noise."""
    kept = without_fixed(matrix, elastic.fixed)
    kept.data[np.abs(kept.data) < 1e-14 * np.abs(kept.data).max(initial=0.0)] = 0.0
    kept.eliminate_zeros()
    return kept


def bordered_step(
    factor: AnyFactor,
    nodal: tuple[np.ndarray, np.ndarray],
    row: Callable[[np.ndarray], np.ndarray],
    border: tuple[np.ndarray, np.ndarray],
) -> tuple[np.ndarray, np.ndarray] | None:
    """Newton step of displacements and motions, by elimination of the displacements.

    None if a motion is not constrained. Every rank calls.

    Parameters
    ----------
    factor : AnyFactor
        Factor of the derivative of the nodal forces by the displacements.
    nodal : tuple
        Residual of the nodal forces, and its derivative by the motions, (n_owned, k).
    row : callable
        Derivative of the balances, applied to displacements (n_owned, columns).
    border : tuple
        Residual of the balances (k,), and its derivative by the motions (k, k).
    """
    (forces, column), (balance, corner) = nodal, border
    solved = factor.solve(np.column_stack([-forces, column]))
    step, column = solved[:, 0], solved[:, 1:]
    if len(balance) == 0:
        return step, np.zeros(0)
    response = row(solved)
    schur = corner - response[:, 1:]
    size = np.sqrt(np.abs(np.diag(schur)))
    if size.min() == 0.0 or np.linalg.cond(schur / np.outer(size, size)) > _SINGULAR:
        return None
    motion = np.linalg.solve(schur, -balance - response[:, 0])
    return step - column @ motion, motion
