"""Boundary of a solid, split at its sharp edges into smooth patches."""

from __future__ import annotations

import numpy as np
import scipy

from ..mesh.nodes import edge_nodes, reference_nodes
from ..mesh.orders import boundary, slopes
from ..mesh.tagged import TaggedMesh

_SMOOTH = np.cos(np.radians(20.0))
"""Cosine of the largest angle between the normals of adjacent facets in one patch."""
_INWARD = ((1, 1.0), (0, -1.0), (1, -1.0), (0, 1.0))
"""Reference coordinate normal to each edge of a quadrilateral, and its inward sign."""


class Patches:
    """Boundary facets of a body of hexahedra, and the edges between its smooth patches.

    Parameters
    ----------
    mesh : TaggedMesh
    cells : ndarray of int, shape (n_cells, nodes_per_cell)
        Cells of the body.
    face : ndarray of int, shape (n,)
        Nodes of the face that moves.

    Attributes
    ----------
    facets : ndarray of int, shape (n_facets, nodes_per_facet)
        All boundary facets, with outward normals by the right-hand rule.
    sliding : ndarray of int, shape (n, nodes_per_facet)
        Facets of the patches that meet the face at a sharp edge.
    seams : ndarray of int, shape (n, order + 1)
        Edges between two such patches: both ends, then the interior nodes.
    still : ndarray of int, shape (n,)
        Nodes of all other patches.
    """

    def __init__(self, mesh: TaggedMesh, cells: np.ndarray, face: np.ndarray):
        self._points, self._order = mesh.points, mesh.order
        self.facets = boundary(mesh.cell_type, mesh.order, cells)
        on_face = np.logical_and.reduce(np.isin(self.facets, face), axis=1)
        self._edges = self.facets[:, edge_nodes("quadrilateral", mesh.order)]
        meeting = _meeting(self._edges)  # edge number: 4 facet + local edge
        one, other = np.moveaxis(self._normals(meeting), 1, 0)
        smooth = np.einsum("ei,ei->e", one, other) > _SMOOTH
        facet = meeting // 4
        inside = ~on_face[facet].any(axis=1)
        links = facet[inside & smooth]
        count = len(self.facets)
        graph = scipy.sparse.coo_matrix((np.ones(len(links)), links.T), shape=(count, count))
        patch = scipy.sparse.csgraph.connected_components(graph, directed=False)[1]
        rim = on_face[facet[:, 0]] != on_face[facet[:, 1]]
        beside = np.where(on_face[facet[:, 0]], *meeting.T[::-1])
        self._sharp, self._level = beside[rim & ~smooth], beside[rim & smooth]
        slides = np.isin(patch, patch[self._sharp // 4]) & ~on_face
        between = inside & (patch[facet[:, 0]] != patch[facet[:, 1]]) & slides[facet].all(axis=1)
        self.sliding = self.facets[slides]
        self.seams = self._edges.reshape(-1, mesh.order + 1)[meeting[between, 0]]
        self.still = np.unique(self.facets[~slides & ~on_face])

    def inward(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes where the face ends at a sharp edge, and unit vectors from them along the side.

        Shapes (n,) and (n, 3); at a corner the vector runs along the seam.
        """
        places = reference_nodes("quadrilateral", self._order)
        local = edge_nodes("quadrilateral", self._order)
        facet, side = np.divmod(self._sharp, 4)
        axis, sense = (np.array(column)[side] for column in zip(*_INWARD, strict=True))
        derivatives = slopes("quadrilateral", self._order, places)[:, axis.astype(int)]
        at = np.take_along_axis(derivatives, local[side].T[..., None], axis=0)
        along = np.einsum("qek,eki->eqi", at, self._points[self.facets[facet]])
        along *= sense[:, None, None] / np.linalg.norm(along, axis=2, keepdims=True)
        nodes, place = np.unique(self._edges[facet, side], return_inverse=True)
        summed = np.zeros((len(nodes), 3))
        np.add.at(summed, place.ravel(), along.reshape(-1, 3))
        return nodes, summed / np.linalg.norm(summed, axis=1, keepdims=True)

    def level(self) -> np.ndarray:
        """Nodes where the boundary continues smoothly beyond the face."""
        return np.unique(self._edges.reshape(-1, self._order + 1)[self._level])

    def _normals(self, edges: np.ndarray) -> np.ndarray:
        """Outward unit normals of facets at the midpoints of edges, shape (..., 3)."""
        facet, side = np.divmod(edges, 4)
        middles = np.array([(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)])
        derivatives = slopes("quadrilateral", self._order, middles)[side]
        tangents = np.einsum("...dk,...ki->d...i", derivatives, self._points[self.facets[facet]])
        normals = np.cross(*tangents)
        return normals / np.linalg.norm(normals, axis=-1, keepdims=True)


def _meeting(edges: np.ndarray) -> np.ndarray:
    """Pairs of edge numbers that are the same edge of two facets, shape (n, 2)."""
    ends = np.sort(edges[..., :2].reshape(-1, 2), axis=1)
    _, number, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    number = number.ravel()
    order = np.argsort(number, kind="stable")
    return order[count[number[order]] == 2].reshape(-1, 2)
