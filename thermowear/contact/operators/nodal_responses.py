"""Response of the nodes of the contact faces of each body to heat into each of them."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ...bulk.column_blocks import blocks
from ...bulk.heat.conduction import Conduction
from .face_nodes import FaceNodes


class NodalResponses:
    """Rises of the nodes of the faces per heat into them, solved for when they are first needed.

    Until then their memory serves the factors with which elasticity is condensed.

    Parameters
    ----------
    conduction : Conduction
    nodes : tuple of FaceNodes
        Nodes of each body.
    """

    def __init__(self, conduction: Conduction, nodes: tuple[FaceNodes, ...]):
        self._conduction, self._nodes = conduction, nodes

    @property
    def symmetric(self) -> bool:
        """True if the responses are symmetric."""
        return self._conduction.symmetric

    @cached_property
    def each(self) -> tuple[np.ndarray, ...]:
        """Φ: nodal rise per nodal heat in each body, shape (n_b, n_b) [K/W]. Every rank calls."""
        conduction = self._conduction.for_columns()
        found = tuple(_nodal_response(conduction, nodes) for nodes in self._nodes)
        conduction.release()
        return found


def _nodal_response(conduction: Conduction, face: FaceNodes) -> np.ndarray:
    """Rise of the nodes of a group per heat into each of them. Every rank calls."""
    spaces, index = conduction.spaces, conduction.spaces.group_of(face.rows)
    group, rows = conduction.in_group(index), spaces.within(index, face.rows)
    nodes, n_owned = face.first + np.arange(len(rows)), len(group.fixed)
    heat = sp.csc_matrix((np.ones(len(rows)), (rows, nodes)), shape=(n_owned, face.count))
    result = np.empty((face.count, face.count), order="F")
    for columns in blocks(face.count, spaces.dim):
        rises = group.respond(heat[:, columns].tocsr())
        result[:, columns] = np.vstack(spaces.comm.allgather(rises[rows]))
    return result
