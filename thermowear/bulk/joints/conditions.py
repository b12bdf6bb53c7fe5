"""Conditions of joints that are independent of each other and stable, also beside fixed values.

Where the first body of a joint has fixed values at it, its free ones may not resolve all functions
of the multipliers: the conditions beyond them would act on the other body alone, and hold it too
much. These functions are added to their neighbours, so that uniform multipliers remain (as at the
ends of mortar faces: Bernardi, Maday and Patera, 1994).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.linalg.lapack import dpstrf
from scipy.sparse.csgraph import connected_components

from ..field import without_fixed
from .joint import Border

_DEPENDENT = 1e-12
"""Part of a condition that is not a combination of others, squared, below which it is one."""


def conditions(border: Border, fixed: np.ndarray, comm) -> sp.csr_array:
    """Independent combinations of the conditions of joints, as columns, shape (m, k).

    Every rank calls.

    Parameters
    ----------
    border : Border
    fixed : ndarray of bool, shape (n_rows,)
        Mask of fixed values.
    comm : mpi4py.MPI.Comm
    """
    key = fixed.tobytes()
    if not all(comm.allgather(key in border.known)):
        joined = _resolved(border, fixed, comm)
        border.known[key] = joined[:, _independent(border, joined, fixed, comm)]
    return border.known[key]


def _resolved(border: Border, fixed: np.ndarray, comm) -> sp.csr_array:
    """Combinations of conditions that the free values of the first bodies resolve."""
    own, free = (_gram(part, comm) for part in (border.own, without_fixed(border.own, fixed)))
    whole = own.diagonal()
    scale = sp.diags_array(1 / np.sqrt(np.where(whole > 0.0, whole, 1.0)))
    own, free = ((scale @ gram @ scale).tocsr() for gram in (own, free))
    own.data[np.abs(own.data) < _DEPENDENT] = 0.0
    own.eliminate_zeros()
    count, result = len(whole), sp.eye_array(len(whole), format="lil")
    missing, dropped = _dependent(own, free, free.diagonal() < own.diagonal()), []
    kept = np.setdiff1d(np.arange(count), missing)
    for one in missing:
        neighbours = np.intersect1d(own[[one]].indices, kept)
        if len(neighbours):
            result[one, neighbours] = 1 / len(neighbours)
            dropped.append(one)
    return sp.csr_array(result)[:, np.setdiff1d(np.arange(count), dropped)]


def _independent(border: Border, joined: sp.csr_array, fixed: np.ndarray, comm) -> np.ndarray:
    """Numbers of conditions that act on free values and do not follow from others.

    Some may follow only where values are fixed, or joints form circles; with a resistance none do.
    """
    jump = border.jump @ joined
    whole, gram = (_gram(sp.csr_matrix(part), comm) for part in (jump, without_fixed(jump, fixed)))
    sizes, size = whole.diagonal(), gram.diagonal()
    acting = np.flatnonzero(size > _DEPENDENT * sizes)
    scale = sp.diags_array(1 / np.sqrt(size[acting]))
    gram = (scale @ gram[acting][:, acting] @ scale).tocsr()
    resisted = (joined.T @ border.resistance @ joined).diagonal()[acting] > 0.0
    risky = ~resisted & (border.closed | (size[acting] < sizes[acting]))
    return np.delete(acting, _dependent(gram, gram, risky))


def _gram(columns: sp.csr_matrix, comm) -> sp.csr_array:
    """Products of columns with each other, of the rows of all ranks."""
    own = sp.csr_array(columns.T @ columns)
    return own if comm.size == 1 else sum(comm.allgather(own), sp.csr_array(own.shape))


def _dependent(links: sp.csr_array, gram: sp.csr_array, risky: np.ndarray) -> np.ndarray:
    """Numbers of conditions that follow from others, by their Gram matrix.

    Cholesky's factorisation with pivots (LAPACK) of each of its blocks, connected by links, with a
    condition that may be dependent. Diagonal entries are at most one.
    """
    block = connected_components(links, directed=False)[1]
    found = [np.zeros(0, dtype=int)]
    for k in np.unique(block[risky]):
        members = np.flatnonzero(block == k)
        _, pivots, rank, _ = dpstrf(gram[members][:, members].toarray(), tol=_DEPENDENT)
        found.append(members[pivots[rank:] - 1])
    return np.concatenate(found)
