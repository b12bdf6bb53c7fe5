"""Distributed matrices and columns gathered on every rank, for sparse complex algebra by scipy."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp


def gathered(matrix: PETSc.Mat) -> sp.csr_matrix:
    """Copy of a distributed matrix on every rank. Every rank calls."""
    indptr, indices, data = matrix.getValuesCSR()
    own = sp.csr_matrix((data, indices, indptr), shape=(len(indptr) - 1, matrix.getSize()[1]))
    return gathered_rows(own, matrix.comm.tompi4py())


def gathered_rows(own: np.ndarray | sp.csr_matrix, comm):
    """Rows of all ranks, dense or sparse, in the order of the ranks. Every rank calls."""
    if comm.size == 1:
        return own
    parts = comm.allgather(own)
    return sp.vstack(parts, format="csr") if sp.issparse(own) else np.concatenate(parts)
