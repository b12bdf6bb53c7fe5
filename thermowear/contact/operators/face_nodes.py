"""Nodes of the temperature on the contact faces; their values are held by all ranks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp


@dataclass(frozen=True)
class FaceNodes:
    """Nodes of the temperature on one face, numbered alike on all ranks.

    Attributes
    ----------
    rows : ndarray of int, shape (n_mine,)
        Owned rows of the nodes of this rank.
    first : int
        Number of the first of them among the n_f nodes of the face.
    values : csr_array, shape (n, n_f)
        P: temperature at the contact points per nodal value; on every rank.
    """

    rows: np.ndarray
    first: int
    values: sp.csr_array

    @property
    def count(self) -> int:
        """Number n_f of the nodes."""
        return self.values.shape[1]

    @property
    def mine(self) -> slice:
        """Numbers of the nodes of this rank."""
        return slice(self.first, self.first + len(self.rows))

    def spread(self, values: np.ndarray, n_owned: int) -> np.ndarray:
        """Owned values of a body, shape (n_owned, k), zero off the face, from (n_f, k) on it."""
        result = np.zeros((n_owned, *values.shape[1:]))
        result[self.rows] = values[self.mine]
        return result


def face_nodes(trace: sp.csr_matrix, comm) -> FaceNodes:
    """Nodes on a face from its transposed trace, shape (n_owned, n). Every rank calls."""
    rows = np.flatnonzero(np.diff(trace.indptr))
    parts = comm.allgather(trace[rows])
    first = sum(part.shape[0] for part in parts[: comm.rank])
    return FaceNodes(rows, first, sp.csr_array(sp.vstack(parts).T))
