"""Direct solver of bodies joined by Lagrange multipliers."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp
from scipy.linalg.lapack import dpstrf
from scipy.sparse.csgraph import connected_components

from ...parallel import sum_over_ranks
from ..direct_solver import DirectSolver
from ..field import without_fixed
from ..spaces import in_petsc
from .joint import Border

_DEPENDENT = 1e-12
"""Part of a condition that is not a combination of others, squared, below which it is one."""


class JoinedSolver:
    """Triangular factorisation of a matrix bordered by the conditions of joints.

    Same interface as `DirectSolver`: the multipliers are unknowns inside. Conditions on fixed
    values alone, and those that follow from others, are left out.

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
        free = without_fixed(border.jump, fixed)
        self._kept = _independent(border, free, self._comm)
        columns = free[:, self._kept]
        self._scale = _scales(matrix, columns, self._comm)
        sizes = matrix.getSizes()[0]
        self._columns = in_petsc(
            (columns @ sp.diags_array(self._scale)).tocsr(), sizes, matrix.comm
        )
        self.repeat()

    def repeat(self) -> None:
        """Factorise the matrix, again after a change of its values. Every rank calls."""
        self._factor = DirectSolver(self._bordered(), *self._known)

    def _bordered(self) -> PETSc.Mat:
        first, last = self._columns.getOwnershipRangeColumn()
        scale = sp.diags_array(self._scale)
        resistance = self._border.resistance[self._kept][:, self._kept]
        # zeros are stored on the diagonal
        resisting = -(scale @ resistance @ scale).tocsr() - 0.0 * sp.eye_array(len(self._kept))
        sizes = self._columns.getSizes()[1]
        block = in_petsc(sp.csr_matrix(resisting)[first:last], sizes, self._matrix.comm)
        rows = [[self._matrix, self._columns], [self._columns.copy().transpose(), block]]
        nest = PETSc.Mat().createNest(rows, comm=self._matrix.comm)
        return nest.convert(PETSc.Mat.Type.AIJ)

    @property
    def negative_pivots(self) -> int:
        """Number of negative pivots beyond those of the multipliers: one each, if regular."""
        return self._factor.negative_pivots - len(self._kept)

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
        mine = slice(*self._columns.getOwnershipRangeColumn())
        weak = (self._scale * jumps[self._kept])[mine]
        found = self._factor.solve(np.concatenate([loads, weak]))
        scaled = np.concatenate(self._comm.allgather(found[len(loads) :]))
        multipliers = np.zeros(len(jumps))
        multipliers[self._kept] = self._scale * scaled
        return found[: len(loads)], multipliers

    def _padded(self, loads: np.ndarray | sp.csr_matrix):
        """Loads with zeros for the multipliers of this rank."""
        first, last = self._columns.getOwnershipRangeColumn()
        none = last - first, *loads.shape[1:]
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


def _independent(border: Border, free: sp.csr_matrix, comm) -> np.ndarray:
    """Conditions on the free values that do not follow from others, in ascending order.

    Some can follow only where values are fixed, or joints form circles. They are found in the Gram
    matrix by Cholesky's factorisation with pivots (LAPACK), in each of its blocks.

    Parameters
    ----------
    border : Border
    free : csr_matrix, shape (n_rows, m)
        Its jumps without the rows of fixed values.
    comm : mpi4py.MPI.Comm
        Every rank calls.
    """
    gram = sum(comm.allgather((free.T @ free).tocsr()))
    whole = sum_over_ranks(comm, np.ravel(border.jump.multiply(border.jump).sum(axis=0)))
    size = gram.diagonal()
    acting = np.flatnonzero(size > _DEPENDENT * whole)
    scale = sp.diags_array(1 / np.sqrt(size[acting]))
    gram = (scale @ gram[acting][:, acting] @ scale).tocsr()
    resisted = border.resistance.diagonal()[acting] > 0.0
    risky = ~resisted & (border.closed | (size[acting] < whole[acting]))
    block = connected_components(gram, directed=False)[1]
    kept: np.ndarray = np.ones(len(acting), dtype=bool)
    for k in np.unique(block[risky]):
        members = np.flatnonzero(block == k)
        _, pivots, rank, _ = dpstrf(gram[members][:, members].toarray(), tol=_DEPENDENT)
        kept[members[pivots[rank:] - 1]] = False
    return acting[kept]
