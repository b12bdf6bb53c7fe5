"""Boundary lines of the parts of a plane body: its outline and the interfaces of its zones.

They are split where they meet, at corners, and where the name of the surface changes. Remeshing
within these lines keeps the outline of a body bitwise.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np

from ...lagrange import lattice, on_lattice
from ..mesh.orders import boundary
from ..mesh.tagged import TaggedMesh

_CORNER = np.cos(np.radians(20.0))
"""Cosine of the largest turn of a smooth line; sharper turns are corners."""

Label = tuple[int, tuple[int, ...], bool]
"""Tag of the surface or 0, tags of the adjacent parts, True if it is the worn face."""


@dataclass(frozen=True)
class OutlinePiece:
    """Boundary line of one or two parts.

    Attributes
    ----------
    ends : tuple of int
        Numbers of the points at its ends, equal if it is closed.
    edges : ndarray, shape (n, order + 1, 2)
        Nodes of its edges, in order along it [m].
    surface : int
        Tag of the surface; 0 if it has no name.
    parts : dict of int to bool
        Tags of the adjacent parts, and True for those on its left.
    is_face : bool
        True if it is the worn face.
    """

    ends: tuple[int, int]
    edges: np.ndarray
    surface: int
    parts: dict[int, bool]
    is_face: bool

    def backwards(self) -> OutlinePiece:
        """Copy with reversed direction."""
        parts = {part: not left for part, left in self.parts.items()}
        return replace(self, ends=self.ends[::-1], edges=self.edges[::-1, ::-1], parts=parts)

    def cut(self, ends: np.ndarray) -> OutlinePiece:
        """Copy with another division into edges.

        Parameters
        ----------
        ends : ndarray
            Ends of the new edges, as numbers and fractions of present ones; no edge spans two.
        """
        order, start = self.edges.shape[1] - 1, ends[:-1]
        of = np.minimum((start + ends[1:]) / 2, len(self.edges) - 0.5).astype(int)
        along = start[:, None] + np.diff(ends)[:, None] * lattice(order)
        values = on_lattice(order, (along - of[:, None]).ravel())[0].reshape(*along.shape, -1)
        edges = np.einsum("njk,nki->nji", values, self.edges[of])
        for side in (0, -1):  # bitwise equal where they are ends of present edges
            number = ends[: len(of)] if side == 0 else ends[1:]
            whole = number == of - side
            edges[whole, side] = self.edges[of[whole], side]
        return replace(self, edges=edges)


def skeleton(mesh: TaggedMesh, parts: tuple[str, ...], face: np.ndarray) -> list[OutlinePiece]:
    """Boundary lines of a body of a plane mesh.

    Parameters
    ----------
    mesh : TaggedMesh
    parts : tuple of str
        Names of the body's parts.
    face : ndarray of int, shape (n,)
        Nodes of its worn face in order along it.
    """
    edges, beside = _edges(mesh, [mesh.bodies.index(part) + 1 for part in parts])
    corners = np.sort(mesh.facets[:, :2], axis=1)
    surfaces = {
        (int(a), int(b)): int(tag) for (a, b), tag in zip(corners, mesh.facet_tags, strict=True)
    }
    on_face = set(face.tolist())
    labels: dict[tuple[int, int], Label] = {}
    for key, edge in edges.items():
        is_face = on_face.issuperset(edge.tolist())
        labels[key] = surfaces.get(key, 0), tuple(sorted(beside[key])), is_face
    at = defaultdict(list)
    for key in edges:
        for end in key:
            at[end].append(key)
    cuts = {point for point, keys in at.items() if _is_cut(mesh.points, point, keys, edges, labels)}
    lines, left = [], set(edges)
    while left:
        # closed lines without split points come last
        key = next((k for k in edges if k in left and not cuts.isdisjoint(k)), None)
        key = next(k for k in edges if k in left) if key is None else key
        chain = _chain(key, edges, at, cuts, left)
        first = min(chain[0][[0, -1]]), max(chain[0][[0, -1]])
        forward = chain[0][0] == edges[first][0]
        along = {part: bool(left_of == forward) for part, left_of in beside[first].items()}
        ends = int(chain[0][0]), int(chain[-1][-1])
        surface, _, is_face = labels[key]
        lines.append(OutlinePiece(ends, mesh.points[np.array(chain)], surface, along, is_face))
    return lines


def _chain(key, edges, at, cuts: set[int], left: set) -> list[np.ndarray]:
    """Nodes of the edges of a line that begins with one; removes them from `left`."""
    point = key[0] if key[0] in cuts or key[1] not in cuts else key[1]
    chain = []
    while key is not None:
        left.remove(key)
        edge = edges[key]
        chain.append(edge if edge[0] == point else edge[::-1])
        point = int(chain[-1][-1])
        onward = () if point in cuts else at[point]
        key = next((k for k in onward if k in left), None)
    return chain


def _edges(mesh: TaggedMesh, tags: list[int]):
    """Boundary edges of the parts by corners, with ordered nodes, and their adjacent parts."""
    edges: dict[tuple[int, int], np.ndarray] = {}
    beside: dict[tuple[int, int], dict[int, bool]] = defaultdict(dict)
    for tag in tags:
        for edge in boundary(mesh.cell_type, mesh.order, mesh.cells[mesh.cell_tags == tag]):
            key = (int(min(edge[:2])), int(max(edge[:2])))
            edges.setdefault(key, np.concatenate([edge[:1], edge[2:], edge[1:2]]))
            beside[key][tag] = bool(edges[key][0] == edge[0])
    return edges, beside


def _is_cut(points: np.ndarray, point: int, keys, edges, labels) -> bool:
    """Test whether lines end at a point where edges meet."""
    if len(keys) != 2 or labels[keys[0]] != labels[keys[1]]:
        return True
    if labels[keys[0]][2]:
        return False
    ways = []
    for key in keys:
        edge = edges[key] if edges[key][0] == point else edges[key][::-1]
        way = points[edge[1]] - points[point]
        ways.append(way / np.linalg.norm(way))
    return bool(-ways[0] @ ways[1] < _CORNER)
