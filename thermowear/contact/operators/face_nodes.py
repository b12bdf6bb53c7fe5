"""Nodes of the temperature on the contact faces of a body, or of glued ones; on all ranks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ...bulk.spaces import Spaces


@dataclass(frozen=True)
class FaceNodes:
    """Nodes of the temperature on the faces of a body, or of glued ones, numbered on all ranks.

    Attributes
    ----------
    rows : ndarray of int, shape (n_mine,)
        Owned rows of the nodes of this rank.
    first : int
        Number of the first of them among the n_b nodes of the body.
    values : tuple of csr_array, shape (n, n_b)
        P: temperature of the first and of the second face at the contact points per nodal value;
        zero at the points of other bodies. On every rank.
    """

    rows: np.ndarray
    first: int
    values: tuple[sp.csr_array, sp.csr_array]

    @property
    def count(self) -> int:
        """Number n_b of the nodes."""
        return self.values[0].shape[1]

    @property
    def mine(self) -> slice:
        """Numbers of the nodes of this rank."""
        return slice(self.first, self.first + len(self.rows))

    def spread(self, values: np.ndarray, n_owned: int) -> np.ndarray:
        """Owned values of a body, shape (n_owned, k), zero off the faces, from (n_b, k) on them."""
        result = np.zeros((n_owned, *values.shape[1:]))
        result[self.rows] = values[self.mine]
        return result


def nodes_by_group(
    spaces: Spaces, traces: tuple[sp.csr_matrix, sp.csr_matrix]
) -> tuple[FaceNodes, ...]:
    """Nodes on the contact faces of each group of bodies that has any, from transposed traces.

    Every rank calls.

    Parameters
    ----------
    spaces : Spaces
        Of the temperatures.
    traces : tuple of csr_matrix, shape (n_owned, n)
        Transposed traces of the first and of the second faces.
    """
    used = np.flatnonzero(np.diff(traces[0].indptr) + np.diff(traces[1].indptr))
    found, every = [], np.arange(spaces.owned)
    for bodies in spaces.groups:
        rows = np.intersect1d(used, every[spaces.rows(*bodies)])
        parts = spaces.comm.allgather([trace[rows] for trace in traces])
        first, second = (sp.csr_array(sp.vstack(side).T) for side in zip(*parts, strict=True))
        if first.shape[1]:
            before = sum(part[0].shape[0] for part in parts[: spaces.comm.rank])
            found.append(FaceNodes(rows, before, (first, second)))
    return tuple(found)
