"""Direct solvers of groups of bodies: each of a body, or of several that are glued together."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...parallel import sum_over_ranks
from ..joints import Border, Joints, conditions
from ..spaces import Rows, Spaces, in_petsc, without_fixed
from .direct import DirectSolver, GroupSolvers


class JoinedSolver:
    """Triangular factorisation of a matrix bordered by the conditions of joints.

    Same interface as `DirectSolver`: the multipliers are unknowns inside, see `conditions`.

    Parameters
    ----------
    matrix : petsc4py.PETSc.Mat
        Assembled, with the rows and columns of fixed values eliminated.
    border : Border
    fixed : ndarray of bool, shape (n_owned,)
        Mask of fixed values.
    symmetry, dim : str, int
        See `DirectSolver`; the factorised matrix is indefinite in any case.
    """

    def __init__(
        self, matrix: PETSc.Mat, border: Border, fixed: np.ndarray, symmetry: str, dim: int
    ):
        self._comm, self._matrix, self._border = matrix.comm.tompi4py(), matrix, border
        self._known = "none" if symmetry == "none" else "symmetric", dim
        self._fixed = fixed
        basis = conditions(border, fixed, self._comm)
        columns, rows = without_fixed(border.jump, fixed) @ basis, matrix.getSizes()[0]
        scale = sp.diags_array(_scales(matrix, columns, self._comm))
        self._basis = (basis @ scale).tocsr()
        self._columns = in_petsc(sp.csr_matrix(columns @ scale), rows, matrix.comm)
        self.repeat()

    def repeat(self) -> None:
        """Factorise the matrix, again after a change of its values. Every rank calls."""
        self._factor = DirectSolver(self._bordered(), *self._known)

    def _bordered(self) -> PETSc.Mat:
        mine, count = self._mine, self._basis.shape[1]
        resisting = self._basis.T @ self._border.resistance @ self._basis
        stored = sp.csr_matrix(-resisting - 0.0 * sp.eye_array(count))  # zeros on the diagonal too
        block = in_petsc(stored[mine], self._columns.getSizes()[1], self._matrix.comm)
        rows = [[self._matrix, self._columns], [self._columns.copy().transpose(), block]]
        nest = PETSc.Mat().createNest(rows, comm=self._matrix.comm)
        return nest.convert(PETSc.Mat.Type.AIJ)

    @property
    def _mine(self) -> slice:
        """Range of the multipliers of this rank."""
        return slice(*self._columns.getOwnershipRangeColumn())

    @property
    def negative_pivots(self) -> int:
        """Number of negative pivots beyond those of the multipliers: one each, if regular."""
        return self._factor.negative_pivots - self._basis.shape[1]

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Solve for one or several right-hand sides, see `DirectSolver.solve`."""
        return self._factor.solve(self._padded(loads))[: loads.shape[0]]

    def solve_transposed(self, loads: np.ndarray) -> np.ndarray:
        """Solve with the transposed matrix; dense loads, shapes as in `solve`."""
        return self._factor.solve_transposed(self._padded(loads))[: len(loads)]

    def closing(self, jumps: np.ndarray) -> np.ndarray:
        """Values without loads whose weak jumps (m,), less those by resistances, are given."""
        return self._response(np.zeros(len(self._fixed)), jumps)[0]

    def multipliers(self, residual: np.ndarray, jumps: np.ndarray) -> np.ndarray:
        """Multipliers (m,) of a solution, fixed values included.

        Parameters
        ----------
        residual : ndarray, shape (n_owned,)
            Loads less those that the matrix gives for the solution.
        jumps : ndarray, shape (m,)
            Weak jumps of the solution.
        """
        return self._response(np.where(self._fixed, 0.0, residual), -jumps)[1]

    def _response(self, loads: np.ndarray, jumps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values and multipliers by loads and weak jumps."""
        weak = (self._basis.T @ jumps)[self._mine]
        found = self._factor.solve(np.concatenate([loads, weak]))
        coefficients = np.concatenate(self._comm.allgather(found[len(loads) :]))
        return found[: len(loads)], self._basis @ coefficients

    def _padded(self, loads: np.ndarray | sp.csr_matrix):
        """Loads with zeros for the multipliers of this rank."""
        none = self._mine.stop - self._mine.start, *loads.shape[1:]
        if isinstance(loads, np.ndarray):
            return np.concatenate([loads, np.zeros(none)])
        return sp.vstack([loads, sp.csr_matrix(none)], format="csr")

    def destroy(self) -> None:
        """Free the memory of the factor."""
        self._factor.destroy()


def _scales(matrix: PETSc.Mat, columns: sp.csr_matrix, comm) -> np.ndarray:
    """Scales of the conditions to the size of the matrix where they act, shape (m,)."""
    diagonal, sizes = matrix.getDiagonal().getArray(), abs(columns)
    parts = sizes.T @ diagonal, sizes.sum(axis=0), columns.multiply(columns).sum(axis=0)
    weighted, summed, squared = sum_over_ranks(comm, np.array([np.ravel(p) for p in parts]))
    return weighted / summed / np.sqrt(squared)


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
