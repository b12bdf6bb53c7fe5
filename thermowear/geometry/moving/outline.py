"""Outline of a plane body: closed loops of boundary edges, split into smooth pieces."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..mesh.nodes import boundary
from ..mesh.tagged import TaggedMesh

COMPLEX = np.array([1.0, 1.0j])
"""Factors that turn plane vectors (..., 2) into complex numbers, whose ratio is an angle."""
CORNER = math.radians(20.0)
"""Smallest angle between edges that makes a corner [rad]."""


@dataclass(frozen=True)
class Piece:
    """Piece of an outline between two corners, with the body to its left.

    Attributes
    ----------
    nodes : ndarray of int, shape (n,)
        Nodes in order, both ends included; the ends coincide if the piece is a closed loop.
    is_face : bool
        True if the piece is the contact face.
    """

    nodes: np.ndarray
    is_face: bool


def loops(mesh: TaggedMesh, face: str) -> list[list[Piece]]:
    """Loops of the outline of a plane body, each a list of pieces in order.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of one body.
    face : str
        Name of its contact face.
    """
    edges = outline_edges(mesh, mesh.cells)
    touching = {tuple(sorted(ends)) for ends in mesh.facets_of(face)[:, :2].tolist()}
    ends = np.sort(edges[:, [0, -1]], axis=1).tolist()
    return split(mesh.points, edges, np.array([tuple(pair) in touching for pair in ends]))


def outline_edges(mesh: TaggedMesh, cells: np.ndarray) -> np.ndarray:
    """Boundary edges of plane cells: nodes in order along each, the cell to its left."""
    edges = boundary(mesh.cell_type, mesh.order, cells)
    return edges[:, [0, *range(2, edges.shape[1]), 1]]


def split(points: np.ndarray, edges: np.ndarray, is_face: np.ndarray) -> list[list[Piece]]:
    """Loops of edges, see `outline_edges`, split at corners and at the ends of the face.

    Parameters
    ----------
    points : ndarray, shape (n_points, 2) [m]
    edges : ndarray of int, shape (n, order + 1)
    is_face : ndarray of bool, shape (n,)
        Mask of the edges of the contact face.
    """
    following = {int(edge[0]): k for k, edge in enumerate(edges)}
    found = []
    while following:
        chain = [following.pop(next(iter(following)))]
        while int(edges[chain[-1], -1]) in following:
            chain.append(following.pop(int(edges[chain[-1], -1])))
        found.append(_pieces(points, edges[chain], is_face[chain]))
    return found


def _pieces(points: np.ndarray, along: np.ndarray, is_face: np.ndarray) -> list[Piece]:
    """Split a closed chain of edges at its corners and at the ends of the contact face."""
    places, before = points[along] @ COMPLEX, np.roll(is_face, 1)
    first, last = places[:, 1] - places[:, 0], places[:, -1] - places[:, -2]
    corner = np.abs(np.angle(first / np.roll(last, 1))) > CORNER
    cuts = np.flatnonzero((corner & ~(is_face & before)) | (is_face != before))
    starts = cuts if len(cuts) else np.array([0])
    pieces = []
    for start, end in zip(starts, np.roll(starts, -1), strict=True):
        count = (end - start) % len(along) or len(along)
        edges = np.arange(start, start + count) % len(along)
        nodes = np.append(along[edges, :-1].ravel(), along[edges[-1], -1])
        pieces.append(Piece(nodes, bool(is_face[start])))
    return pieces
