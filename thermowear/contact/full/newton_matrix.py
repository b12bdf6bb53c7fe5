"""Newton matrix of contact on the full system, refactorised when the active set changes."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...bulk.group_solvers import AnyFactor, factorised
from ...bulk.mechanics.elasticity import Elasticity, supported
from ...bulk.spaces import distributed
from ...errors import ComputationError

_SAME_PATTERN = PETSc.Mat.Structure.SAME_NONZERO_PATTERN
_SUBSET_PATTERN = PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN
_DIFFERENT_PATTERN = PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN


class NewtonMatrix:
    """Matrix ``K - Sᵀ diag(b) S + W a C``, with factors a that vary from step to step.

    K is the supported stiffness. W and C are kept for all points, open or closed, so that sparsity
    pattern and elimination order are computed only once. With several components of the tractions
    the operators list those of all points one component after the other, and a couples the
    components at each point. All methods are collective.

    Parameters
    ----------
    elastic : Elasticity
    work, closing, stress : csr_matrix, shape (n_owned, components n)
        W, Cᵀ and Sᵀ, without supported rows.
    subtracted : ndarray, shape (components n,)
        Factors b.
    symmetry : str
        Symmetry as in `DirectSolver`.
    components : int
        Number of components of the tractions.
    """

    def __init__(
        self,
        elastic: Elasticity,
        work: sp.csr_matrix,
        closing: sp.csr_matrix,
        stress: sp.csr_matrix,
        subtracted: np.ndarray,
        symmetry: str,
        components: int = 1,
    ):
        self._symmetry, self._dim, self._fixed = symmetry, elastic.bodies.dim, elastic.fixed
        self._border = elastic.joints.border(range(len(elastic.each)), slice(None))
        fixed = supported(elastic.stiffness, elastic.fixed)
        if subtracted.any():
            columns = distributed(elastic.spaces, stress)
            rows = columns.copy().transpose()
            _scale_rows(rows, subtracted)
            fixed.axpy(-1.0, columns.matMult(rows), _DIFFERENT_PATTERN)
        self._columns = distributed(elastic.spaces, work)
        self._rows = distributed(elastic.spaces, closing).transpose()
        self._coupling = _pointwise(components, work.shape[1] // components, self._rows.comm)
        self._weighted_rows = self._coupling.matMult(self._rows)
        self._product = self._columns.matMult(self._weighted_rows)
        self._matrix = fixed.copy()
        self._matrix.axpy(1.0, self._product, _DIFFERENT_PATTERN)
        self._constant = self._matrix.copy()
        self._constant.zeroEntries()
        self._constant.axpy(1.0, fixed, _SUBSET_PATTERN)
        self._factor: AnyFactor | None = None
        self._factors = np.zeros(0)

    def factor(self, factors: np.ndarray) -> AnyFactor:
        """Factorise the matrix for values of a, shape (n,) or (components, components, n).

        Raises
        ------
        ComputationError
            If the symmetric variant of Nitsche's method is found unstable.
        """
        if self._factor is not None and np.array_equal(self._factors, factors):
            return self._factor
        _set_pointwise(self._coupling, factors if factors.ndim == 3 else factors[None, None])
        self._coupling.matMult(self._rows, self._weighted_rows)
        self._columns.matMult(self._weighted_rows, self._product)
        self._constant.copy(self._matrix, _SAME_PATTERN)
        self._matrix.axpy(1.0, self._product, _SUBSET_PATTERN)
        if self._factor is None:
            known = self._border, self._fixed, self._symmetry, self._dim
            self._factor = factorised(self._matrix, *known)
        else:
            self._factor.repeat()
        if self._symmetry == "symmetric" and self._factor.negative_pivots:
            self._factors = np.zeros(0)
            raise ComputationError(
                "contact: Nitsche's method is unstable with this stabilisation; make contact.gamma "
                "larger or set contact.theta = -1"
            )
        self._factors = factors
        return self._factor


def _scale_rows(matrix: PETSc.Mat, factors: np.ndarray) -> None:
    """Multiply the rows, one per contact point, by factors replicated on all ranks."""
    scale = matrix.createVecLeft()
    first, last = scale.getOwnershipRange()
    scale.setArray(factors[first:last])
    matrix.diagonalScale(scale, None)


def _pointwise(components: int, count: int, comm: PETSc.Comm) -> PETSc.Mat:
    """Square matrix that couples the components at each of a number of points."""
    size = components * count
    matrix = PETSc.Mat().createAIJ(((PETSc.DECIDE, size),) * 2, nnz=components, comm=comm)
    _set_pointwise(matrix, np.zeros((components, components, count)))
    return matrix


def _set_pointwise(matrix: PETSc.Mat, values: np.ndarray) -> None:
    """Set the entries to values (components, components, n), replicated on all ranks."""
    c, _, n = values.shape
    first, last = matrix.getOwnershipRange()
    rows = np.arange(first, last)
    columns = np.arange(c) * n + (rows % n)[:, None]
    starts = np.arange(0, c * len(rows) + 1, c)
    entries = values.transpose(0, 2, 1).reshape(c * n, c)[first:last]
    indices = (each.astype(PETSc.IntType) for each in (starts, columns.ravel()))
    matrix.setValuesCSR(*indices, np.ascontiguousarray(entries.ravel()))
    matrix.assemble()
