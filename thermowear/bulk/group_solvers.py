"""Direct solvers of groups of bodies: each of a body, or of several that are glued together."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from .direct_solver import DirectSolver, GroupSolvers
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


def group_solvers(
    matrix: PETSc.Mat,
    spaces: Spaces,
    joints: Joints,
    fixed: np.ndarray,
    symmetry: str,
    one_at_a_time: bool = False,
) -> GroupSolvers:
    """Triangular factorisation of a matrix that does not couple groups of bodies; collective.

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
        See `GroupSolvers`.
    """
    rows = [spaces.rows(*bodies) for bodies in spaces.groups]
    borders = [joints.border(*group) for group in zip(spaces.groups, rows, strict=True)]
    blocks = [_diagonal_block(matrix, own) for own in rows]
    assert sum(map(_entries, blocks)) == _entries(matrix), "the matrix couples bodies"

    def make(group: int) -> AnyFactor:
        own = borders[group], fixed[rows[group]]
        return factorised(blocks[group], *own, symmetry, spaces.dim)

    return GroupSolvers(rows, [border.columns for border in borders], make, one_at_a_time)


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
