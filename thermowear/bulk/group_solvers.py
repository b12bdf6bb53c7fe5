"""Direct solvers of groups of bodies: each of a body, or of several that are glued together."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from .direct_solver import DirectSolver
from .joints.joined_solver import JoinedSolver
from .joints.joint import Border, Joints
from .spaces import Rows, Spaces

AnyFactor = DirectSolver | JoinedSolver
"""Factor of a group."""


def factorised(
    matrix: PETSc.Mat, border: Border, fixed: np.ndarray, symmetry: str, dim: int
) -> AnyFactor:
    """Factorise a matrix, bordered by the conditions of joints if there are any.

    Parameters as in `JoinedSolver`. Every rank calls.
    """
    if border.count:
        return JoinedSolver(matrix, border, fixed, symmetry, dim)
    return DirectSolver(matrix, symmetry, dim)


class GroupSolvers:
    """Triangular factorisation of a matrix that does not couple groups of bodies.

    Parameters
    ----------
    matrix : petsc4py.PETSc.Mat
        Assembled and distributed by rows.
    spaces : Spaces
    joints : Joints
    fixed : ndarray of bool, shape (n_owned,)
    symmetry : str
        See `DirectSolver`.
    one_at_a_time : bool
        True if a factor is made when it is first needed, and freed before that of another group.
    """

    def __init__(
        self,
        matrix: PETSc.Mat,
        spaces: Spaces,
        joints: Joints,
        fixed: np.ndarray,
        symmetry: str,
        one_at_a_time: bool = False,
    ):
        self._known, self._alone = (symmetry, spaces.dim), one_at_a_time
        self._fixed, self._comm = fixed, spaces.comm
        self._rows = [spaces.rows(*bodies) for bodies in spaces.groups]
        self._borders = [
            joints.border(*group) for group in zip(spaces.groups, self._rows, strict=True)
        ]
        self._blocks = [_diagonal_block(matrix, rows) for rows in self._rows]
        assert sum(map(_entries, self._blocks)) == _entries(matrix), "the matrix couples bodies"
        self._factors: dict[int, AnyFactor] = {}
        if not one_at_a_time:
            for group in range(len(self._rows)):
                self.of(group)

    def of(self, group: int) -> AnyFactor:
        """Solver of one group. Every rank calls."""
        if group not in self._factors:
            self.release()
            own = self._borders[group], self._fixed[self._rows[group]]
            self._factors[group] = factorised(self._blocks[group], *own, *self._known)
        return self._factors[group]

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Solve for one or several right-hand sides, see `DirectSolver.solve`."""
        result = np.empty(loads.shape, order="F")
        for group, rows in enumerate(self._rows):
            result[rows] = self.of(group).solve(loads[rows])
        return result

    def solve_transposed(self, loads: np.ndarray) -> np.ndarray:
        """Solve with the transposed matrix; dense loads, shapes as in `solve`."""
        result = np.empty(loads.shape, order="F")
        for group, rows in enumerate(self._rows):
            result[rows] = self.of(group).solve_transposed(loads[rows])
        return result

    def closing(self, jumps: np.ndarray) -> np.ndarray:
        """Values without loads of given weak jumps, see `JoinedSolver.closing`."""
        result = np.zeros(len(self._fixed))
        for group, border, rows in self._joined:
            result[rows] = group.closing(jumps[border.columns])
        return result

    def multipliers(self, residual: np.ndarray, jumps: np.ndarray) -> np.ndarray:
        """Multipliers of all joints, see `JoinedSolver.multipliers`."""
        result = np.zeros(len(jumps))
        for group, border, rows in self._joined:
            result[border.columns] = group.multipliers(residual[rows], jumps[border.columns])
        return result

    @property
    def _joined(self):
        """Solvers of groups with joints, with their borders and rows."""
        for group, (border, rows) in enumerate(zip(self._borders, self._rows, strict=True)):
            if border.count:
                yield self.of(group), border, rows

    def release(self) -> None:
        """Free the memory of a factor that is not kept anyway."""
        if self._alone:
            self.destroy()

    def destroy(self) -> None:
        """Free the memory of the factors."""
        while self._factors:
            self._factors.popitem()[1].destroy()


class SolverInGroup:
    """Solver of all bodies for loads and solutions of one group of them.

    Parameters
    ----------
    solver : MultigridSolver or EvenFactor
    spaces : Spaces
    group : int
        Index of the group.
    """

    def __init__(self, solver, spaces: Spaces, group: int):
        self._solver, self._spaces = solver, spaces
        self._rows = spaces.rows(*spaces.groups[group])

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Solutions of the group by columns, see `DirectSolver.solve`."""
        return self._solver.solve(self._spaces.placed(self._rows, loads))[self._rows]

    def solve_transposed(self, loads: np.ndarray) -> np.ndarray:
        """Solve with the transposed matrix, see `DirectSolver.solve_transposed`."""
        return self._solver.solve_transposed(self._spaces.placed(self._rows, loads))[self._rows]


def solver_in_group(solver, spaces: Spaces, group: int):
    """Solver of the loads of one group, from that of all. Every rank calls."""
    if len(spaces.groups) == 1:
        return solver
    if isinstance(solver, GroupSolvers):
        return solver.of(group)
    return SolverInGroup(solver, spaces, group)


def _diagonal_block(matrix: PETSc.Mat, rows: Rows) -> PETSc.Mat:
    """Part of a matrix with given owned rows, and columns alike. Every rank calls."""
    start = matrix.getOwnershipRange()[0]
    if isinstance(rows, slice):
        size, first = rows.stop - rows.start, start + rows.start
        own = PETSc.IS().createStride(size, first, 1, comm=matrix.comm)
    else:
        own = PETSc.IS().createGeneral((rows + start).astype(PETSc.IntType), comm=matrix.comm)
    return matrix.createSubMatrix(own, own)


def _entries(matrix: PETSc.Mat) -> int:
    """Number of entries on all ranks."""
    return int(matrix.getInfo(PETSc.Mat.InfoType.GLOBAL_SUM)["nz_used"])
