"""Outline of a plane body: closed loops of boundary edges, split into smooth pieces."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..mesh.nodes import boundary
from ..mesh.tagged import TaggedMesh, compact

_CORNER = math.radians(20.0)
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


def only_body(mesh: TaggedMesh, parts: tuple[str, ...]) -> TaggedMesh:
    """Mesh of one body, with its surfaces.

    Parameters
    ----------
    mesh : TaggedMesh
    parts : tuple of str
        Names of the body and its zones.
    """
    tags = sorted(mesh.bodies.index(part) + 1 for part in parts if part in mesh.bodies)
    cells = np.isin(mesh.cell_tags, tags)
    has = np.zeros(len(mesh.points), dtype=bool)
    has[mesh.cells[cells]] = True
    facets = has[mesh.facets].all(axis=1)
    marks, facet_tags = np.unique(mesh.facet_tags[facets], return_inverse=True)
    return compact(
        replace(
            mesh,
            cells=mesh.cells[cells],
            cell_tags=(np.searchsorted(tags, mesh.cell_tags[cells]) + 1).astype(np.int32),
            facets=mesh.facets[facets],
            facet_tags=(facet_tags + 1).astype(np.int32),
            bodies=tuple(mesh.bodies[tag - 1] for tag in tags),
            surfaces=tuple(mesh.surfaces[mark - 1] for mark in marks),
        )
    )


def loops(mesh: TaggedMesh, face: str) -> list[list[Piece]]:
    """Loops of the outline of a plane body, each a list of pieces in order.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of one body.
    face : str
        Name of its contact face.
    """
    edges = boundary(mesh.cell_type, mesh.order, mesh.cells)
    on_face = mesh.facets[mesh.facet_tags == mesh.surfaces.index(face) + 1]
    touching = {tuple(sorted(ends)) for ends in on_face[:, :2].tolist()}
    following = {int(edge[0]): edge for edge in edges}
    found = []
    while following:
        chain = [following.pop(next(iter(following)))]
        while int(chain[-1][1]) in following:
            chain.append(following.pop(int(chain[-1][1])))
        is_face = np.array([tuple(sorted(edge[:2].tolist())) in touching for edge in chain])
        found.append(_pieces(mesh.points, np.array(chain), is_face))
    return found


def _pieces(points: np.ndarray, chain: np.ndarray, is_face: np.ndarray) -> list[Piece]:
    """Split a closed chain of edges at its corners and at the ends of the contact face."""
    along = np.column_stack([chain[:, 0], chain[:, 2:], chain[:, 1]])
    first = points[along[:, 1]] - points[along[:, 0]]
    last = points[along[:, -1]] - points[along[:, -2]]
    turn = _angle(np.roll(last, 1, axis=0), first)
    cuts = np.flatnonzero(
        ((np.abs(turn) > _CORNER) & ~(is_face & np.roll(is_face, 1)))
        | (is_face != np.roll(is_face, 1))
    )
    starts = cuts if len(cuts) else np.array([0])
    pieces = []
    for start, end in zip(starts, np.roll(starts, -1), strict=True):
        count = (end - start) % len(chain) or len(chain)
        edges = np.arange(start, start + count) % len(chain)
        nodes = np.append(along[edges, :-1].ravel(), along[edges[-1], -1])
        pieces.append(Piece(nodes, bool(is_face[start])))
    return pieces


def _angle(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Angle from one direction to the other, shape (n,) [rad]."""
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.arctan2(cross, (before * after).sum(axis=1))
