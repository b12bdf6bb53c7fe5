"""Closest facets of surfaces with slender curved facets, such as narrow rows along a round rim.

Where a facet is curved by more than a fraction of its width, its plane approximation is closer to
points of neighbouring facets than to its own ones. Points all over the facets bound the distance
instead: each facet that can be the closest one is a candidate.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...lagrange import lattice
from .facets import FacetSet

_SLENDER = 0.2
"""Deviation of the edges from chords, relative to the width of a facet, of slender facets."""
_PIECES = 10.0
"""Squared number of pieces along the sides of a facet, relative to that deviation."""
_MOST_PIECES = 8
_MARGIN = 1.05
"""Radius of a sphere round a piece relative to the distance of the points in it."""
_AT_ONCE = 4096
"""Number of points that are searched together."""


def slenderness(face: FacetSet) -> np.ndarray:
    """Deviation of nodes from plane facets with straight edges, relative to the width, (n,)."""
    every = np.arange(len(face.nodes))[:, None]
    off = np.linalg.norm(
        face.flattened.points(every, lattice(face.order, face.kind)) - face.nodes, axis=2
    )
    first, second = face.flattened.sides.swapaxes(0, 1)
    sides = [first, second, first - second] if face.kind == "triangle" else [first, second]
    longest = np.max([np.linalg.norm(side, axis=1) for side in sides], axis=0)
    return off.max(axis=1) * longest / np.linalg.norm(np.cross(first, second), axis=1)


class SampledFacets:
    """Points on the facets, and spheres round the pieces of facets about them.

    Parameters
    ----------
    face : FacetSet
        Surface.
    slender : ndarray of bool, shape (n_facets,)
        Facets that are divided into pieces.
    pieces : int
        Number of pieces along their sides.
    """

    def __init__(self, face: FacetSet, slender: np.ndarray, pieces: int):
        self._face, self._slender = face, slender
        parts = [(np.flatnonzero(~slender), 1), (np.flatnonzero(slender), pieces)]
        found = [_pieces(face, facets, count) for facets, count in parts]
        self._facet, self._t, points, radii = (np.concatenate(v) for v in zip(*found, strict=True))
        octave = np.floor(np.log2(radii / radii.min())).astype(int)
        groups = [np.flatnonzero(octave == k) for k in np.unique(octave)]
        self._trees = [(g, cKDTree(points[g]), _MARGIN * float(radii[g].max())) for g in groups]

    def near(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Pairs of a point (n, 3) and a facet that can be its closest one.

        Returns
        -------
        point, facet : ndarray of int, shape (n_pairs,)
            Ascending.
        start : ndarray, shape (n_pairs, 2)
            Parameters on the facet near the closest place.
        """
        starts = range(0, len(points), _AT_ONCE)
        parts = [self._near(points[i : i + _AT_ONCE], i) for i in starts]
        point, facet, start = (np.concatenate(column) for column in zip(*parts, strict=True))
        plane = np.flatnonzero(~self._slender[facet])
        flat = self._face.flattened.parameters(facet[plane], points[point[plane]])
        start[plane] = self._face.inside(flat)
        return point, facet, start

    def _near(self, points: np.ndarray, offset: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        bound = np.min([tree.query(points)[0] for _, tree, _ in self._trees], axis=0)
        found, pieces, distances = [], [], []
        for members, tree, radius in self._trees:
            lists = tree.query_ball_point(points, bound + radius)
            point = np.repeat(np.arange(len(points)), [len(part) for part in lists])
            local = np.concatenate(lists).astype(np.int64)
            found.append(point)
            pieces.append(members[local])
            distances.append(np.linalg.norm(points[point] - tree.data[local], axis=1))
        point, piece = np.concatenate(found), np.concatenate(pieces)
        facet = self._facet[piece]
        order = np.lexsort((np.concatenate(distances), facet, point))
        point, facet, piece = point[order], facet[order], piece[order]
        new = (np.diff(point, prepend=-1) != 0) | (np.diff(facet, prepend=-1) != 0)
        return point[new] + offset, facet[new], self._t[piece[new]]


def sampled(face: FacetSet) -> SampledFacets | None:
    """Sampled facets of a surface; None if no facet is slender and curved."""
    found = slenderness(face) if face.order > 1 else np.zeros(1)
    if found.max() <= _SLENDER:
        return None
    pieces = min(int(np.ceil(np.sqrt(_PIECES * found.max()))), _MOST_PIECES)
    return SampledFacets(face, found > _SLENDER, pieces)


def _pieces(face: FacetSet, facets: np.ndarray, count: int) -> tuple[np.ndarray, ...]:
    """Pieces of facets: facet, parameters of the middle, its place, and radius about it [m]."""
    origin, size = _division(face.kind, count)
    middle = origin + size[:, None] * lattice(1, face.kind).mean(axis=0)
    rim = origin[:, None] + size[:, None, None] * lattice(2, face.kind)
    facet, t = np.repeat(facets, len(middle)), np.tile(middle, (len(facets), 1))
    points = face.points(facet, t)
    around = face.points(
        np.repeat(facet, rim.shape[1]), np.tile(rim.reshape(-1, 2), (len(facets), 1))
    )
    apart = around.reshape(len(points), rim.shape[1], 3) - points[:, None]
    return facet, t, points, np.linalg.norm(apart, axis=2).max(axis=1, initial=0.0)


def _division(kind: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Origins (n, 2) and sizes (n,) of equal parts of a facet; negative if turned by 180°."""
    steps = np.stack(np.meshgrid(*[np.arange(count)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    if kind != "triangle":
        return steps / count, np.full(len(steps), 1 / count)
    total = steps.sum(axis=1)
    upright, turned = steps[total < count], steps[total < count - 1] + 1
    sizes = np.repeat([1 / count, -1 / count], [len(upright), len(turned)])
    return np.concatenate([upright, turned]) / count, sizes
