"""Motion of the boundary of a body in space whose face has moved into it.

The boundary is split at its sharp edges into smooth patches. Sides that meet the face at an angle
slide along themselves up to their next sharp edge, and so do the edges between them; the rest of
the boundary is fixed. All by harmonic extension, first in the edges, then in the sides; last, in
the body, interior nodes follow (`bulk.mesh_motion`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from ...lagrange import gauss
from ..mesh.nodes import (
    boundary,
    components,
    edge_nodes,
    meeting,
    reference_nodes,
    shape_functions,
    slopes,
)
from ..mesh.tagged import TaggedMesh
from .moved import Extension, MovableFace, cells_of, nodes_at

_SMOOTH = np.cos(np.radians(20.0))
"""Cosine of the largest angle between the normals of adjacent facets in one patch."""
_INWARD = {
    "quadrilateral": np.array([(0, 1), (-1, 0), (0, -1), (1, 0)]),
    "triangle": np.array([(0, 1), (-1, -1), (1, 0)]),
}
"""Directions away from each edge of a facet, in its reference coordinates."""


class Patches:
    """Boundary facets of a body in space, and the edges between its smooth patches.

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
    own : ndarray of int, shape (n, nodes_per_facet)
        Facets of the face.
    still : ndarray of int, shape (n,)
        Nodes of all other patches.
    """

    def __init__(self, mesh: TaggedMesh, cells: np.ndarray, face: np.ndarray):
        self._mesh = mesh
        self._points, self._order, self._kind = mesh.points, mesh.order, mesh.facet_type
        self.facets = boundary(mesh.cell_type, mesh.order, cells)
        on_face = np.logical_and.reduce(np.isin(self.facets, face), axis=1)
        self._edges = self.facets[:, edge_nodes(self._kind, mesh.order)]
        sides = self._edges.shape[1]  # edge number: sides * facet + local edge
        pairs = meeting(self._edges[..., :2].reshape(-1, 2))
        one, other = np.moveaxis(self._normals(pairs), 1, 0)
        smooth = np.einsum("ei,ei->e", one, other) > _SMOOTH
        facet = pairs // sides
        inside = ~on_face[facet].any(axis=1)
        self._patch = patch = components(facet[inside & smooth], len(self.facets))
        rim = on_face[facet[:, 0]] != on_face[facet[:, 1]]
        beside = np.where(on_face[facet[:, 0]], *pairs.T[::-1])
        self._sharp, self._level = beside[rim & ~smooth], beside[rim & smooth]
        slides = np.isin(patch, patch[self._sharp // sides]) & ~on_face
        between = inside & (patch[facet[:, 0]] != patch[facet[:, 1]]) & slides[facet].all(axis=1)
        self.sliding = self.facets[slides]
        self.seams = self._edges.reshape(-1, mesh.order + 1)[pairs[between, 0]]
        self.own = self.facets[on_face]
        self.still = np.unique(self.facets[~slides & ~on_face])

    def inward(self, extension: Extension) -> tuple[np.ndarray, np.ndarray]:
        """Nodes where the face ends at a sharp edge, and unit vectors from them along the side.

        Shapes (n,) and (n, 3); at a corner the vector runs along the seam. In a side of triangles
        vectors are normal to the edge in its middle, and turn towards the seams at its ends.

        Parameters
        ----------
        extension : callable
            Factory of harmonic extensions along the edges.
        """
        local = edge_nodes(self._kind, self._order)
        facet, side = np.divmod(self._sharp, len(local))
        edges, along = self._edges[facet, side], self._from_edges(facet, side)
        nodes = np.unique(edges)
        at_seams = self._seams_from(nodes)
        summed = np.zeros((len(self._points), 3))
        for number in np.unique(self._patch[facet]):
            own = self._patch[facet] == number
            vectors = np.zeros_like(summed)
            np.add.at(vectors, edges[own].ravel(), along[own].reshape(-1, 3))
            ends = np.unique(edges[own])
            vectors[ends] /= np.linalg.norm(vectors[ends], axis=1, keepdims=True)
            if self._kind == "triangle":
                vectors += self._turn(edges[own], vectors, at_seams, extension)
            summed += vectors
        for ends, seams in at_seams:
            summed[ends] = seams
        return nodes, summed[nodes] / np.linalg.norm(summed[nodes], axis=1, keepdims=True)

    def _from_edges(self, facet: np.ndarray, side: np.ndarray) -> np.ndarray:
        """Unit vectors into facets from the nodes of their edges, shape (n, order + 1, 3)."""
        local = edge_nodes(self._kind, self._order)
        at = slopes(self._kind, self._order, reference_nodes(self._kind, self._order))[local[side]]
        tangents = np.einsum("eqdk,eki->eqdi", at, self._points[self.facets[facet]])
        along = np.einsum("ed,eqdi->eqi", _INWARD[self._kind][side], tangents)
        if self._kind == "triangle":  # normal to the edge, as rows of nodes run in all directions
            corners = reference_nodes(self._kind, 1)
            edge = np.einsum("ed,eqdi->eqi", (np.roll(corners, -1, 0) - corners)[side], tangents)
            part = (along * edge).sum(axis=2) / (edge**2).sum(axis=2)
            along -= part[..., None] * edge
        return along / np.linalg.norm(along, axis=2, keepdims=True)

    def _turn(
        self,
        edges: np.ndarray,
        vectors: np.ndarray,
        at_seams: list[tuple[np.ndarray, np.ndarray]],
        extension: Extension,
    ) -> np.ndarray:
        """Change of vectors (n_points, 3) along the edge of a side, by which they turn to seams."""
        known, given = np.zeros(len(self._points), dtype=bool), np.zeros_like(vectors)
        for ends, seams in at_seams:
            here = np.isin(ends, edges)
            given[ends[here]] = seams[here] - vectors[ends[here]]
            known[ends[here]] = True
        if not known.any():
            return given
        return extension(self._mesh, "interval", edges, known)(given)

    def _seams_from(self, nodes: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Some of the nodes (n,), at the first or last end of a seam, and unit tangents there."""
        derivatives = slopes("interval", self._order, np.array([[0.0], [1.0]]))[:, 0]
        tangents = np.einsum("qk,ski->qsi", derivatives, self._points[self.seams])
        found = []
        for end, tangent in enumerate((tangents[0], -tangents[1])):
            starts = np.isin(self.seams[:, end], nodes) & ~np.isin(self.seams[:, 1 - end], nodes)
            size = np.linalg.norm(tangent[starts], axis=1, keepdims=True)
            found.append((self.seams[starts, end], tangent[starts] / size))
        return found

    def level(self) -> np.ndarray:
        """Nodes where the boundary continues smoothly beyond the face."""
        return np.unique(self._edges.reshape(-1, self._order + 1)[self._level])

    def _normals(self, edges: np.ndarray) -> np.ndarray:
        """Outward unit normals of facets at the midpoints of edges, shape (..., 3)."""
        corners = reference_nodes(self._kind, 1)
        facet, side = np.divmod(edges, len(corners))
        middles = (corners + np.roll(corners, -1, axis=0)) / 2
        derivatives = slopes(self._kind, self._order, middles)[side]
        tangents = np.einsum("...dk,...ki->d...i", derivatives, self._points[self.facets[facet]])
        normals = np.cross(*tangents)
        return normals / np.linalg.norm(normals, axis=-1, keepdims=True)


class MovableSolid(MovableFace):
    """Body of a mesh in space whose worn face can be moved.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh in space.
    parts : tuple of str
        Names of the body's parts.
    face : ndarray, shape (n, 3)
        Coordinates of the nodes of its face [m].
    extension : callable
        Factory of harmonic extensions into the edges and sides.
    """

    def __init__(
        self, mesh: TaggedMesh, parts: tuple[str, ...], face: np.ndarray, extension: Extension
    ):
        self._mesh = mesh
        self._extension = extension
        self.face = nodes_at(mesh, parts, face)
        self._patches = Patches(mesh, cells_of(mesh, parts), self.face)

    def motion_paths(self, normals):
        # from the rim on the inclination to the normal varies harmonically, as paths must not cross
        every, turn = np.zeros_like(self._mesh.points), np.zeros_like(self._mesh.points)
        every[self.face] = normals
        nodes, inward = self._patches.inward(self._extension)
        level, known = self._patches.level(), np.zeros(len(every), dtype=bool)
        turn[nodes] = -inward - every[nodes]
        known[nodes] = known[level] = True
        if np.any(turn != 0.0):
            turn = self._extension(self._mesh, self._mesh.facet_type, self._patches.own, known)(
                turn
            )
        paths = (every + turn)[self.face]
        return paths / np.linalg.norm(paths, axis=1, keepdims=True), np.isin(self.face, level)

    def outlined(self, displacement):
        given = np.zeros_like(self._mesh.points)
        given[self.face] = displacement
        for extended in self._extensions:
            given = extended(given)
        return given

    def lost(self, outlined, factor):
        facets = self._patches.facets
        facets = facets[np.any(outlined[facets] != 0.0, axis=(1, 2))]
        points = self._mesh.points[facets]
        points = points - points.reshape(-1, 3).mean(axis=0)
        kind, order = self._mesh.facet_type, self._mesh.order
        before, after = (_enclosed(kind, order, p) for p in (points, points + outlined[facets]))
        return (before - after) * float(factor(np.zeros((1, 3)))[0])

    @cached_property
    def _extensions(self) -> list[Callable[[np.ndarray], np.ndarray]]:
        """Harmonic extensions into the edges between the sliding sides, then into these sides."""
        known = np.zeros(len(self._mesh.points), dtype=bool)
        known[self._patches.still] = known[self.face] = True
        found = []
        patches, facets = self._patches, self._mesh.facet_type
        for kind, cells in (("interval", patches.seams), (facets, patches.sliding)):
            if len(cells):
                found.append(self._extension(self._mesh, kind, cells, known.copy()))
                known[cells] = True
        return found


def _enclosed(kind: str, order: int, facets: np.ndarray) -> float:
    """Contribution of facets (n, n_nodes, 3) to ``∮ x·n dS / 3``."""
    places, weights = gauss(2 * order + 1, kind)
    points = np.einsum("qk,fki->fqi", shape_functions(kind, order, places), facets)
    tangents = np.einsum("qdk,fki->dfqi", slopes(kind, order, places), facets)
    return float(np.einsum("fqi,fqi,q->", points, np.cross(*tangents), weights)) / 3
