"""Solvers of one body, from those of all."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from .direct_solver import BodySolvers
from .spaces import Spaces


class SolverInBody:
    """Solver of all bodies for loads and solutions of one of them.

    Parameters
    ----------
    solver : MultigridSolver or EvenFactor
    spaces : Spaces
    index : int
        Index of the body.
    """

    def __init__(self, solver, spaces: Spaces, index: int):
        self._solver, self._spaces, self._index = solver, spaces, index

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Solutions of the body by columns, see `DirectSolver.solve`."""
        return self._cut(self._solver.solve(self._spaces.placed(self._index, loads)))

    def solve_transposed(self, loads: np.ndarray) -> np.ndarray:
        """Solve with the transposed matrix, see `DirectSolver.solve_transposed`."""
        return self._cut(self._solver.solve_transposed(self._spaces.placed(self._index, loads)))

    def _cut(self, values: np.ndarray) -> np.ndarray:
        return self._spaces.split(values)[self._index]


def solver_in_body(solver, spaces: Spaces, index: int):
    """Solver of the loads of one body, from that of all. Every rank calls."""
    if len(spaces.each) == 1:
        return solver
    if isinstance(solver, BodySolvers):
        return solver.of(index)
    return SolverInBody(solver, spaces, index)
