"""Direct solvers of the bodies: one factor for each, made and freed one by one if need be."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from .direct_solver import DirectSolver
from .spaces import Spaces


class BodySolvers:
    """Triangular factorisation of a matrix that does not couple the bodies.

    Parameters
    ----------
    matrix : petsc4py.PETSc.Mat
        Assembled, in the layout of `spaces`.
    spaces : Spaces
    symmetry : str
        See `DirectSolver`.
    one_at_a_time : bool
        True if a factor is made when it is first needed, and freed before that of another body.
    """

    def __init__(
        self,
        matrix: PETSc.Mat,
        spaces: Spaces,
        symmetry: str = "definite",
        one_at_a_time: bool = False,
    ):
        self._spaces, self._symmetry, self._alone = spaces, symmetry, one_at_a_time
        self._blocks = [_diagonal_block(matrix, spaces, i) for i in range(len(spaces.each))]
        assert sum(map(_entries, self._blocks)) == _entries(matrix), "the matrix couples bodies"
        self._factors: dict[int, DirectSolver] = {}
        if not one_at_a_time:
            for index in range(len(spaces.each)):
                self.of(index)

    def of(self, index: int) -> DirectSolver:
        """Solver of one body. Every rank calls."""
        if index not in self._factors:
            self.release()
            block = self._blocks[index]
            self._factors[index] = DirectSolver(block, self._symmetry, self._spaces.dim)
        return self._factors[index]

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Solve for one or several right-hand sides, see `DirectSolver.solve`."""
        result = np.empty(loads.shape, order="F")
        for index, load in enumerate(self._spaces.split(loads)):
            self._spaces.split(result)[index][...] = self.of(index).solve(load)
        return result

    def solve_transposed(self, loads: np.ndarray) -> np.ndarray:
        """Solve with the transposed matrix; dense loads, shapes as in `solve`."""
        result = np.empty(loads.shape, order="F")
        for index, load in enumerate(self._spaces.split(loads)):
            self._spaces.split(result)[index][...] = self.of(index).solve_transposed(load)
        return result

    def release(self) -> None:
        """Free the memory of a factor that is not kept anyway."""
        if self._alone:
            self.destroy()

    def destroy(self) -> None:
        """Free the memory of the factors."""
        while self._factors:
            self._factors.popitem()[1].destroy()


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


def _diagonal_block(matrix: PETSc.Mat, spaces: Spaces, index: int) -> PETSc.Mat:
    """Rows and columns of one body. Every rank calls."""
    first = matrix.getOwnershipRange()[0]
    start, end = spaces.starts[index : index + 2]
    own = PETSc.IS().createStride(int(end - start), int(first + start), 1, comm=matrix.comm)
    return matrix.createSubMatrix(own, own)


def _entries(matrix: PETSc.Mat) -> int:
    """Number of entries on all ranks."""
    return int(matrix.getInfo(PETSc.Mat.InfoType.GLOBAL_SUM)["nz_used"])
