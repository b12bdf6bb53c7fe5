"""Motion of the outline of a plane body whose face has moved into it.

Sides adjacent to the face slide along themselves up to their next corner, the rest of the
outline is fixed. Interior nodes follow by harmonic extension (`bulk.mesh_motion`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...lagrange import gauss, on_lattice
from ..mesh.nodes import chord_lengths
from ..mesh.tagged import TaggedMesh
from .outline import COMPLEX, CORNER, outline_edges, split

Extension = Callable[
    [TaggedMesh, str, np.ndarray, np.ndarray | None], Callable[[np.ndarray], np.ndarray]
]
"""Factory of harmonic extensions, see `bulk.mesh_motion.serial_extension`."""


@dataclass(frozen=True)
class OutlineSide:
    """Side: smooth part of a body's outline adjacent to an end of its worn face.

    Attributes
    ----------
    nodes : ndarray of int, shape (n,)
        Nodes from the end of the face to the next corner.
    inward : ndarray, shape (2,)
        Unit vector from the end of the face along the side.
    is_corner : bool
        True if face and side meet at an angle; otherwise the side continues the face smoothly.
    """

    nodes: np.ndarray
    inward: np.ndarray
    is_corner: bool


class MovableFace(ABC):
    """Worn face of a body that can be moved, and the motion of the body's outline with it.

    Attributes
    ----------
    face : ndarray of int, shape (n,)
        Nodes of the face.
    """

    face: np.ndarray

    @abstractmethod
    def motion_paths(self, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Outward directions of motion of the nodes of the face, and mask of the fixed ones.

        Nodes at the ends (or the rim) of the face move along the sides, or are fixed where the
        outline continues smoothly.

        Parameters
        ----------
        normals : ndarray, shape (n, gdim)
            Outward normals at the nodes of the face.

        Returns
        -------
        directions : ndarray, shape (n, gdim)
        held : ndarray of bool, shape (n,)
        """

    @abstractmethod
    def outlined(self, displacement: np.ndarray) -> np.ndarray:
        """Displacement of the outline when the face moves, zero inside; (n_points, gdim) [m].

        Parameters
        ----------
        displacement : ndarray, shape (n, gdim)
            Displacement of the nodes of the face; at its ends along the sides [m].
        """

    @abstractmethod
    def lost(self, outlined: np.ndarray, factor: Callable[[np.ndarray], np.ndarray]) -> float:
        """Volume that the body loses by a displacement of its outline [m³].

        By Gauss's theorem on its moved part only, as it may be tiny relative to the body's volume.

        Parameters
        ----------
        outlined : ndarray, shape (n_points, gdim)
            Displacement of the outline, see `outlined` [m].
        factor : callable
            Factor from area to volume at points of shape (n, gdim); linear in x in a plane,
            constant in space.
        """


class MovableBody(MovableFace):
    """Body of a plane mesh whose worn face can be moved.

    Parameters
    ----------
    mesh : TaggedMesh
    parts : tuple of str
        Names of the body's parts.
    face : ndarray, shape (n, 2)
        Coordinates of the nodes of its face, in order along it [m].
    """

    def __init__(self, mesh: TaggedMesh, parts: tuple[str, ...], face: np.ndarray):
        self._mesh = mesh
        self.face = nodes_at(mesh, parts, face)
        self._edges = outline_edges(mesh, cells_of(mesh, parts))
        ends = self.face[:2], self.face[:-3:-1]
        self.sides = tuple(map(self._side, ends, self._beside()))

    def motion_paths(self, normals):
        # in between, the inclination to the normal varies linearly, so that paths do not cross
        held, turn = np.zeros(len(normals), dtype=bool), np.zeros(2)
        paths = normals @ COMPLEX
        for k, side in enumerate(self.sides):
            held[-k] = not side.is_corner
            if side.is_corner:
                turn[k] = np.angle(-side.inward @ COMPLEX / paths[-k])
        length = chord_lengths(self._mesh.points[self.face])
        part = length / length[-1]
        paths = paths * np.exp(1j * ((1 - part) * turn[0] + part * turn[1]))
        return np.column_stack([paths.real, paths.imag]), held

    def outlined(self, displacement):
        given = np.zeros_like(self._mesh.points)
        for side, end in zip(self.sides, (displacement[0], displacement[-1]), strict=True):
            given[side.nodes] = self._slide_displacement(side, float(end @ side.inward))
        given[self.face] = displacement
        return given

    def lost(self, outlined, factor):
        edges = self._edges[np.any(outlined[self._edges] != 0.0, axis=(1, 2))]
        points = self._mesh.points[edges]
        return enclosed(points, factor) - enclosed(points + outlined[edges], factor)

    def _slide_displacement(self, side: OutlineSide, way: float) -> np.ndarray:
        """Displacement of the nodes of a side along it, given that of its first node [m]."""
        points = self._mesh.points[side.nodes]
        if not side.is_corner:
            return np.zeros_like(points)
        length = chord_lengths(points)
        to = length + way * (1 - length / length[-1])
        where = np.column_stack([np.interp(to, length, x) for x in points.T])
        before = np.minimum(to, 0.0)[:, None] * side.inward  # a face that has grown
        return where + before - points

    def _beside(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes of the outline from both ends of the face to the next corners."""
        is_face = np.logical_and.reduce(np.isin(self._edges[:, [0, -1]], self.face), axis=1)
        pieces, k = next(
            (loop, k)
            for loop in split(self._mesh.points, self._edges, is_face)
            for k, piece in enumerate(loop)
            if piece.is_face
        )
        if len(pieces) == 1:
            return self.face[:1], self.face[-1:]
        before, after = pieces[k - 1].nodes[::-1], pieces[(k + 1) % len(pieces)].nodes
        return (before, after) if before[0] == self.face[0] else (after, before)

    def _side(self, ends: np.ndarray, along: np.ndarray) -> OutlineSide:
        """Side with nodes `along` it, given the first two nodes of the face from there."""
        if len(along) == 1:
            return OutlineSide(along, np.zeros(2), False)
        points = self._mesh.points
        inward, from_face = points[[along[1], ends[0]]] - points[[along[0], ends[1]]]
        turn = abs(np.angle(inward @ COMPLEX / (from_face @ COMPLEX)))
        return OutlineSide(along, inward / np.linalg.norm(inward), bool(turn > CORNER))


def cells_of(mesh: TaggedMesh, parts: tuple[str, ...]) -> np.ndarray:
    """Cells of some parts of a mesh, shape (n_cells, nodes_per_cell)."""
    return mesh.cells[np.isin(mesh.cell_tags, mesh.tags_of(parts))]


def nodes_at(mesh: TaggedMesh, parts: tuple[str, ...], places: np.ndarray) -> np.ndarray:
    """Nodes of some parts of a mesh that are nearest to places (n, gdim), shape (n,)."""
    own = np.unique(cells_of(mesh, parts))
    return own[cKDTree(mesh.points[own]).query(places)[1]]


def enclosed(edges: np.ndarray, factor: Callable[[np.ndarray], np.ndarray]) -> float:
    """Contribution of edges (n, n_nodes, 2) to ``∮ G dy``, G the integral of a factor along x."""
    order = edges.shape[1] - 1
    t, w = gauss(2 * order + 1)
    values, slopes = on_lattice(order, t, 1)
    x, y = np.einsum("qk,nki->inq", values, edges)
    rise = np.einsum("qk,nk->nq", slopes, edges[..., 1])
    halfway = np.stack([x / 2, y], axis=-1).reshape(-1, 2)
    return float(np.tile(w, len(edges)) @ (factor(halfway) * (x * rise).ravel()))
