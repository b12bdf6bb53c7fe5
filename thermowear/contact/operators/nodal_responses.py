"""Response of the nodes of both contact faces to heat into each of them."""

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
    faces : tuple of FaceNodes
    """

    def __init__(self, conduction: Conduction, faces: tuple[FaceNodes, FaceNodes]):
        self._conduction, self._faces = conduction, faces

    @property
    def symmetric(self) -> bool:
        """True if the responses are symmetric."""
        return self._conduction.symmetric

    @cached_property
    def each(self) -> tuple[np.ndarray, np.ndarray]:
        """Φ: nodal rise per nodal heat on each face, shape (n_f, n_f) [K/W]. Every rank calls."""
        conduction = self._conduction.for_columns()
        first, second = (_nodal_response(conduction, face) for face in self._faces)
        conduction.release()
        return first, second


def _nodal_response(conduction: Conduction, face: FaceNodes) -> np.ndarray:
    """Rise of the nodes of a face per heat into each of them. Every rank calls."""
    spaces, index = conduction.spaces, conduction.spaces.group_of(face.rows)
    group, rows = conduction.in_group(index), spaces.within(index, face.rows)
    nodes, n_owned = face.first + np.arange(len(rows)), len(group.fixed)
    heat = sp.csc_matrix((np.ones(len(rows)), (rows, nodes)), shape=(n_owned, face.count))
    result = np.empty((face.count, face.count), order="F")
    for columns in blocks(face.count, spaces.dim):
        rises = group.respond(heat[:, columns].tocsr())
        result[:, columns] = np.vstack(spaces.comm.allgather(rises[rows]))
    return result
