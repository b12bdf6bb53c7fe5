"""Boundary lines of the parts of a plane body, and their division for a quadrilateral mesh.

Lines are the outline of the body and the interfaces of its zones, split where they meet, at
corners, and where the name of the surface changes. Remeshing within these lines keeps the outline
of a body bitwise. The quadrilateral mesh is generated with cells twice as long as the edges, then
refined. Edges are therefore grouped in pairs of similar length; an edge without a similar neighbour
is halved, and so are pairs much longer than their neighbours, also around corners.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np

from ...errors import ComputationError
from ...lagrange import lattice, on_lattice
from ..mesh.nodes import chord_lengths
from ..mesh.tagged import TaggedMesh
from .outline import COMPLEX, CORNER, outline_edges

Label = tuple[int, tuple[int, ...], bool]
"""Tag of the surface or 0, tags of the adjacent parts, True if it is the worn face."""
_UNEVEN = 1.6
"""Largest length ratio of the two edges of a pair."""
_GROWTH = 4.0
"""Largest length ratio of neighbouring pairs."""
_LIKE = 1e9
"""Largest ratio of lengths of edges that halves can even out."""


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
    edges, beside = _edges(mesh, mesh.tags_of(parts))
    corners = (tuple(map(int, pair)) for pair in np.sort(mesh.facets[:, :2], axis=1))
    surfaces = dict(zip(corners, map(int, mesh.facet_tags), strict=True))
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
        waiting = [k for k in edges if k in left]
        key = next((k for k in waiting if not cuts.isdisjoint(k)), waiting[0])
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
        for edge in outline_edges(mesh, mesh.cells[mesh.cell_tags == tag]):
            first, last = sorted(edge[[0, -1]].tolist())
            kept = edges.setdefault((first, last), edge)
            beside[first, last][tag] = bool(kept[0] == edge[0])
    return edges, beside


def _is_cut(points: np.ndarray, point: int, keys, edges, labels) -> bool:
    """Test whether lines end at a point where edges meet."""
    if len(keys) != 2 or labels[keys[0]] != labels[keys[1]]:
        return True
    if labels[keys[0]][2]:
        return False
    ends = [edges[key][1 if edges[key][0] == point else -2] for key in keys]
    one, other = (points[ends] - points[point]) @ COMPLEX
    return bool(abs(np.angle(-other / one)) > CORNER)


def even(lines: list[OutlinePiece]) -> list[np.ndarray]:
    """Edge ends of the new division of each line, as numbers and fractions of its edges."""
    chords = [chord_lengths(np.vstack([line.edges[:, 0], line.edges[-1:, -1]])) for line in lines]
    edges = np.concatenate(list(map(np.diff, chords)))
    if not edges.min() > edges.max() / _LIKE:  # halving would not end
        raise ComputationError("edges of the outline shrink to points")
    pairs = [_paired(np.diff(chord)) for chord in chords]
    while True:
        # with uniform chord length within each edge
        lengths = [
            np.diff(np.interp(ends, np.arange(len(chord)), chord))
            for ends, chord in zip(pairs, chords, strict=True)
        ]
        far = [a > b for a, b in zip(lengths, _limits(lines, lengths), strict=True)]
        if not any(map(np.any, far)):
            return [_halved(ends, ...) for ends in pairs]
        pairs = list(map(_halved, pairs, far))


def _paired(lengths: np.ndarray) -> np.ndarray:
    """Ends of pairs of neighbours of similar length, and of single edges, by numbers of edges."""
    ends = [0]
    while ends[-1] < len(lengths):
        k = ends[-1]
        short, long = min(lengths[k : k + 2]), max(lengths[k : k + 2])
        ends.append(k + (2 if k + 1 < len(lengths) and long <= _UNEVEN * short else 1))
    return np.array(ends, dtype=float)


def _halved(ends: np.ndarray, which) -> np.ndarray:
    """Ends of pairs, some of which are divided into halves."""
    return np.sort(np.append(ends, ((ends[:-1] + ends[1:]) / 2)[which]))


def _limits(lines: list[OutlinePiece], lengths: list[np.ndarray]) -> list[np.ndarray]:
    """Largest length of the pairs of each line, given by their neighbours."""
    at: dict[int, float] = {}
    for line, own in zip(lines, lengths, strict=True):
        for end, length in zip(line.ends, own[[0, -1]], strict=True):
            at[end] = min(length, at.get(end, np.inf))
    found = []
    for line, own in zip(lines, lengths, strict=True):
        around = np.concatenate([[at[line.ends[0]]], own, [at[line.ends[1]]]])
        found.append(_GROWTH * np.minimum(around[:-2], around[2:]))
    return found
