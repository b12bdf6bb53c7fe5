"""Distributed sparse matrices: direct solvers (MUMPS) for many right-hand sides, and products."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...errors import ComputationError

_MOST_COLUMNS = {2: 32, 3: 128}
"""Right-hand sides per solution, by dimension; limited by the caches."""
_BLOCK_MEMORY, _LEAST = 1.5e8, 32
"""Memory of the solutions of a block [bytes], unless it has the least number of columns."""


def blocks(count: int, dim: int, rows: int = 0) -> Iterator[slice]:
    """Ranges of columns of a number of rows that are solved for together, in a dimension `dim`."""
    fitting = int(_BLOCK_MEMORY / (8 * max(rows, 1)))
    size = min(_MOST_COLUMNS[dim], max(fitting, _LEAST))
    return (slice(start, min(start + size, count)) for start in range(0, count, size))


_SINGULAR = "it is singular: a part of a body is not supported, or its cells are degenerate"
_FAILURES = {
    -6: _SINGULAR,
    -9: "its work space was too small",
    -10: _SINGULAR,
    -13: "the memory does not suffice; use fewer elements, a lower degree, or in space "
    'mesh.solver = "multigrid"',
}
"""Reasons by the error code of MUMPS (INFOG(1))."""
_TYPES = PETSc.PC.Type.CHOLESKY, PETSc.PC.Type.LU
_TOO_SMALL = -8, -9
"""Codes of a workspace that was estimated too small."""
_LARGER = 50, 200, 1000
"""Increases of the estimated workspace that are then tried (ICNTL(14)); 20 or so at first [%]."""
_ORDERINGS = {2: 2, 3: 4}
"""Ordering of MUMPS (ICNTL(7)) by dimension of the mesh. In 2D approximate minimum fill: for 1e4 to
3e5 unknowns twice as fast as the default of MUMPS, with the same fill. In 3D PORD: for 5e4 to 2e5
unknowns 10 to 20 % faster than minimum fill, with 10 % less fill; Debian's MUMPS offers no other.
Measured."""
_FEW = 5_000
"""Unknowns up to which the ordering is that of 2D: PORD ends the process by exit() where all
unknowns are coupled to all others, as those of a single cell (at most some 2 000 of degree 8)."""
_COLUMNS = 128
"""Block size of right-hand sides (ICNTL(27)); twice as fast as the default of MUMPS, measured."""


class DirectSolver:
    """Triangular factorisation (MUMPS) of a PETSc matrix.

    Parameters
    ----------
    matrix : petsc4py.PETSc.Mat
        Assembled and distributed by rows.
    symmetry : str
        Known property of the matrix: ``"definite"`` (symmetric positive definite),
        ``"symmetric"`` or ``"none"``.
    dim : int
        Dimension of the mesh, which selects the ordering.

    Raises
    ------
    ComputationError
        If the matrix is singular or too large.
    """

    def __init__(self, matrix: PETSc.Mat, symmetry: str = "definite", dim: int = 2):
        if symmetry != "none":
            matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
            matrix.setOption(PETSc.Mat.Option.SPD, symmetry == "definite")
        self._comm, self._matrix = matrix.comm, matrix
        self._rows = matrix.getSizes()[0]
        ordering = _ORDERINGS[dim if matrix.getSize()[0] > _FEW else 2]
        self._factorises = _TYPES[symmetry == "none"], ordering
        self._prepare()
        self.repeat()

    def _prepare(self, workspace: int | None = None) -> None:
        """Set MUMPS up, with an increase of the estimated workspace [%] other than its own."""
        type_, ordering = self._factorises
        self._solver = PETSc.KSP().create(self._comm)
        self._solver.setOperators(self._matrix)
        self._solver.setType(PETSc.KSP.Type.PREONLY)
        preconditioner = self._solver.getPC()
        preconditioner.setType(type_)
        preconditioner.setFactorSolverType(PETSc.Mat.SolverType.MUMPS)
        preconditioner.setFactorSetUpSolverType()
        self._factored = preconditioner.getFactorMatrix()
        self._factored.setMumpsIcntl(7, ordering)
        self._factored.setMumpsIcntl(27, _COLUMNS)
        if workspace is not None:
            self._factored.setMumpsIcntl(14, workspace)

    def repeat(self) -> None:
        """Factorise the matrix, again after a change of values with unchanged sparsity pattern."""
        self._solver.getPC().setUp()
        for workspace in _LARGER:
            if self._factored.getMumpsInfog(1) not in _TOO_SMALL:
                break
            self.destroy()
            self._prepare(workspace)
            self._solver.getPC().setUp()
        code = self._factored.getMumpsInfog(1)
        if code < 0:
            reason = _FAILURES.get(code, "see INFOG(1) in the manual of MUMPS")
            raise ComputationError(f"a matrix cannot be factorised (MUMPS error {code}): {reason}")

    def destroy(self) -> None:
        """Free the memory of the factor, also where others still refer to this solver."""
        self._factored.destroy()
        self._solver.destroy()
        return_freed_memory()

    @property
    def negative_pivots(self) -> int:
        """Number of negative pivots (eigenvalues, by Sylvester's law) of a symmetric matrix."""
        return self._factored.getMumpsInfog(12)

    def solve(self, loads: np.ndarray | sp.csr_matrix) -> np.ndarray:
        """Solve for one or several right-hand sides.

        Parameters
        ----------
        loads : ndarray or csr_matrix, shape (n_owned,) or (n_owned, m)
            Rows owned by this rank. Every rank calls. Sparse loads are solved faster.

        Returns
        -------
        ndarray
            Solutions, same shape.
        """
        if not isinstance(loads, np.ndarray) and self._comm.size > 1:
            loads = loads.toarray()  # MUMPS needs sparse right-hand sides on one rank
        elif not isinstance(loads, np.ndarray) and loads.nnz == 0:
            return np.zeros(loads.shape, order="F")  # MUMPS needs entries (error -22, at random)
        flat = loads if loads.ndim == 2 else loads[:, None]  # a rank may own nothing
        dense = isinstance(flat, np.ndarray)
        right = self._dense(np.asfortranarray(flat)) if dense else self._sparse(flat)
        result = np.empty(flat.shape, order="F")  # written in place: it may be large
        x = self._dense(result)
        for matrix in (right, x):
            matrix.assemble()
        self._factored.matSolve(right, x)
        for matrix in (right, x):
            matrix.destroy()
        return result.reshape(loads.shape, order="F")

    def solve_transposed(self, loads: np.ndarray) -> np.ndarray:
        """Solve with the transposed matrix; dense loads, shapes as in `solve`."""
        self._factored.setMumpsIcntl(9, 0)  # PETSc's own transposed solve takes a single column
        try:
            return self.solve(loads)
        finally:
            self._factored.setMumpsIcntl(9, 1)

    def _dense(self, columns: np.ndarray) -> PETSc.Mat:
        sizes = (self._rows, columns.shape[1])
        return PETSc.Mat().createDense(sizes, array=columns, comm=self._comm)

    def _sparse(self, loads: sp.csr_matrix) -> PETSc.Mat:
        """Transposed PETSc matrix of the loads, as PETSc passes sparse columns to MUMPS."""
        columns = loads.tocsc()
        columns.sort_indices()
        indices = (columns.indptr.astype(PETSc.IntType), columns.indices.astype(PETSc.IntType))
        transposed = PETSc.Mat().createAIJ(
            columns.shape[::-1], csr=(*indices, columns.data), comm=self._comm
        )
        return PETSc.Mat().createTranspose(transposed)


class GroupSolvers:
    """Solvers of groups of bodies that are not coupled.

    Parameters
    ----------
    rows : sequence of slice or ndarray of int
        Owned rows of each group.
    columns : sequence of ndarray of int
        Multipliers of the joints in each group.
    make : callable
        Solver of a group by its index.
    one_at_a_time : bool
        True if a solver is made when it is first needed, and freed before that of another group.
    """

    def __init__(
        self,
        rows: Sequence[slice | np.ndarray],
        columns: Sequence[np.ndarray],
        make: Callable[[int], Any],
        one_at_a_time: bool = False,
    ):
        self._rows, self._columns, self._make, self._alone = rows, columns, make, one_at_a_time
        self._factors: dict[int, Any] = {}
        if not one_at_a_time:
            for group in range(len(rows)):
                self.of(group)

    def of(self, group: int) -> Any:
        """Solver of one group. Every rank calls."""
        if group not in self._factors:
            self.release()
            self._factors[group] = self._make(group)
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
        """Values without loads of given weak jumps, see `bulk.solvers.groups`."""
        result = np.zeros(sum(len(np.r_[rows]) for rows in self._rows))
        for solver, columns, rows in self._joined:
            result[rows] = solver.closing(jumps[columns])
        return result

    def multipliers(self, residual: np.ndarray, jumps: np.ndarray) -> np.ndarray:
        """Multipliers of all joints, see `bulk.solvers.groups`."""
        result = np.zeros(len(jumps))
        for solver, columns, rows in self._joined:
            result[columns] = solver.multipliers(residual[rows], jumps[columns])
        return result

    @property
    def _joined(self):
        """Solvers of groups with joints, with their multipliers and rows."""
        for group, (columns, rows) in enumerate(zip(self._columns, self._rows, strict=True)):
            if len(columns):
                yield self.of(group), columns, rows

    def release(self) -> None:
        """Free the memory of a factor that is not kept anyway."""
        if self._alone:
            self.destroy()

    def destroy(self) -> None:
        """Free the memory of the factors."""
        while self._factors:
            self._factors.popitem()[1].destroy()


def return_freed_memory() -> None:
    """Return freed memory to the system: the C library keeps the small blocks of a factor."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:  # glibc
        trim(0)


def multiply(matrix: PETSc.Mat, values: np.ndarray) -> np.ndarray:
    """Product of a matrix and a vector of owned values. Every rank calls."""
    x, y = matrix.createVecs()
    x.setArray(values)
    matrix.mult(x, y)
    return y.getArray().copy()


def eliminate(matrix: PETSc.Mat, fixed: np.ndarray) -> None:
    """Eliminate rows and columns of fixed values (n_owned,), in place. Every rank calls.

    Their diagonal entries become the largest one of the matrix.
    """
    rows = (np.flatnonzero(fixed) + matrix.getOwnershipRange()[0]).astype(PETSc.IntType)
    largest = float(np.abs(matrix.getDiagonal().getArray()).max(initial=0.0))
    matrix.zeroRowsColumns(rows, diag=max(matrix.comm.tompi4py().allgather(largest)))
