"""Polygon clipping of opposite surface facets, for the common refinement of two faces.

Polygons are cut by the method of Sutherland and Hodgman (Commun. ACM 17 (1974) 32), all together:
the corners of all polygons are one list.

All operations are done in the parameters of a facet of body 1, a unit square or triangle: the
outlines of the facets of body 2 are mapped to it at the points opposite to them (see
`common_face`), and clipped by its sides (Sutherland and Hodgman, Commun. ACM 17 (1974) 32). Shared
edges of facets of body 2 have the same image, so that the parts adjoin without gaps, on curved
facets too. All pairs of facets are treated together: the corners of all polygons are one list.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...lagrange import lattice
from ..faces.face import Surface
from ..faces.projection import inside, within
from .common_face import MAX_FACING_COSINE, opposite, opposite_parameters

_TOLERANCE = 1e-9
"""Area of an inverted triangle that is rounding."""


def without_folds(
    points: np.ndarray, of: np.ndarray, parts: np.ndarray, of_part: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of polygons, replaced by `ears` in polygons of which some are inverted.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Corners of the polygons, one after the other, anticlockwise.
    of : ndarray of int, shape (n,)
        Number of the polygon of each corner.
    parts : ndarray, shape (n_parts, 4, 2)
        Triangles whose last two corners coincide.
    of_part : ndarray of int, shape (n_parts,)

    Returns
    -------
    parts, of_part : ndarray
    """
    first, second = np.moveaxis(parts[:, 1:3] - parts[:, :1], 1, 0)
    folded = np.unique(of_part[_cross(first, second) < -_TOLERANCE])
    kept = ~np.isin(of_part, folded)
    found, numbers = [parts[kept]], [of_part[kept]]
    for number in folded:  # few: slender ones between two curved edges
        cut = ears(points[of == number])
        found.append(cut[:, [0, 1, 2, 2]])
        numbers.append(np.full(len(cut), number))
    return np.concatenate(found), np.concatenate(numbers)


def ears(polygon: np.ndarray) -> np.ndarray:
    """Triangles of a simple polygon, by cutting off one corner after the other.

    An ear is a convex corner whose triangle with its neighbours contains no other corner (Meisters,
    Amer. Math. Monthly 82 (1975) 648); the one of the largest smallest height is cut off.

    Parameters
    ----------
    polygon : ndarray, shape (n, 2)
        Corners, anticlockwise.

    Returns
    -------
    ndarray, shape (n - 2, 3, 2)
        Anticlockwise.
    """
    found, left = [], polygon
    while len(left) > 3:
        candidates = np.stack([np.roll(left, 1, axis=0), left, np.roll(left, -1, axis=0)], axis=1)
        quality = np.where(_holds_a_corner(candidates, left), -np.inf, _height(candidates))
        k = int(quality.argmax())
        found.append(candidates[k])
        left = np.delete(left, k, axis=0)
    return np.array([*found, left])


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _height(triangles: np.ndarray) -> np.ndarray:
    """Smallest height of triangles (n, 3, 2), negative for clockwise ones, shape (n,)."""
    sides = np.roll(triangles, -1, axis=1) - triangles
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    return _cross(sides[:, 0], sides[:, 1]) / np.maximum(longest, 1e-300)


def _holds_a_corner(triangles: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Mask of the triangles (n, 3, 2) that contain one of n corners other than their own."""
    sides = np.roll(triangles, -1, axis=1) - triangles
    off = _cross(sides[:, :, None], corners - triangles[:, :, None])
    inside = np.all(off >= 0.0, axis=1)
    n = len(corners)
    for shift in (-1, 0, 1):
        inside[np.arange(n), (np.arange(n) + shift) % n] = False
    return inside.any(axis=1)


TOLERANCE = 1e-9
"""Relative size of a facet below which corners coincide with each other or with a side."""


class Polygons(NamedTuple):
    """Corners of polygons in one list, those of each polygon one after the other.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
    of : ndarray of int, shape (n,)
        Number of the polygon, ascending.
    """

    points: np.ndarray
    of: np.ndarray

    @property
    def first(self) -> np.ndarray:
        """Index of the first corner of each polygon."""
        return np.flatnonzero(np.diff(self.of, prepend=-1))

    @property
    def before(self) -> np.ndarray:
        """Index of the corner before each corner."""
        first, result = self.first, np.arange(len(self.of)) - 1
        result[first] = np.append(first[1:], len(self.of)) - 1
        return result

    @property
    def after(self) -> np.ndarray:
        """Index of the corner after each corner."""
        result = np.empty(len(self.of), dtype=np.int64)
        result[self.before] = np.arange(len(self.of))
        return result

    def per_corner(self, values: np.ndarray) -> np.ndarray:
        """Values of the polygons, repeated for each of their corners."""
        return np.repeat(values, np.diff(np.append(self.first, len(self.of))))

    def only(self, kept: np.ndarray) -> Polygons:
        """Polygons of the chosen corners."""
        return Polygons(self.points[kept], self.of[kept])


def anticlockwise(polygons: Polygons) -> Polygons:
    """Polygons without orientation reversed where they run clockwise."""
    p, following = polygons.points, polygons.points[polygons.after]
    area = np.bincount(polygons.of, p[:, 0] * following[:, 1] - p[:, 1] * following[:, 0])
    first = polygons.first
    last = np.append(first[1:], len(p)) - 1
    every = np.arange(len(p))
    mirrored = polygons.per_corner(first + last) - every
    return polygons._replace(points=p[np.where(area[polygons.of] > 0, every, mirrored)])


def cut(polygons: Polygons, height: np.ndarray) -> Polygons:
    """Parts of polygons where the interpolated height of their corners is nonnegative."""
    before = polygons.before
    lower = height[before]
    crossed = ((height > 0) & (lower < 0)) | ((height < 0) & (lower > 0))
    part = np.divide(lower, lower - height, out=np.zeros_like(height), where=crossed)[:, None]
    start = polygons.points[before]
    points = np.stack([start + part * (polygons.points - start), polygons.points], axis=1)
    kept = np.column_stack([crossed, height >= 0])
    return Polygons(points[kept], np.repeat(polygons.of, 2).reshape(-1, 2)[kept])


def tidied(polygons: Polygons) -> Polygons:
    """Polygons without redundant corners; those of less than three corners vanish."""
    while len(polygons.of):
        turn, first = np.abs(_turns(polygons)), polygons.first
        least = np.minimum.reduceat(turn, first)
        count = np.diff(np.append(first, len(turn)))
        small = polygons.per_corner(count) < 3
        flattest = polygons.per_corner(np.where(least > TOLERANCE, -1.0, least)) == turn
        candidates = np.flatnonzero(flattest)
        removed = candidates[np.unique(polygons.of[candidates], return_index=True)[1]]
        small[removed] = True
        if not small.any():
            break
        polygons = polygons.only(~small)
    return polygons


def _turns(polygons: Polygons) -> np.ndarray:
    """Distance of each corner from the line of its neighbours, positive for a left turn."""
    p = polygons.points
    before, after = p - p[polygons.before], p[polygons.after] - p
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    longer = np.maximum(np.hypot(*before.T), np.hypot(*after.T))
    return across / np.maximum(longer, TOLERANCE)


def divided(polygons: Polygons, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Parts (n, 4, 2) of polygons, and the polygon of each.

    Convex polygons are divided from their first corner, into quadrilaterals in those, into
    triangles in triangles; others into triangles about the mean of their corners or, where that
    does not see all sides, by cutting off ears.
    """
    p, of, first = polygons.points, polygons.of, polygons.first
    if not len(of):
        return np.empty((0, 4, 2)), of
    count = np.diff(np.append(first, len(of)))
    convex = np.minimum.reduceat(_turns(polygons), first) >= 0
    step = 1 if kind == "triangle" else 2
    parts = np.where(convex, (count - 3) // step + 1, 0)
    origin, sides = np.repeat(first, parts), np.repeat(count, parts)
    k = 1 + step * (np.arange(len(origin)) - np.repeat(np.cumsum(parts) - parts, parts))
    fan = np.stack([0 * k, k, k + 1, (k + step) % sides], axis=1)
    bent = np.flatnonzero(~polygons.per_corner(convex))
    following = p[polygons.after]
    mean = np.column_stack([np.bincount(of, x)[of] / np.bincount(of)[of] for x in p.T])
    about = np.stack([mean, p, following, following], axis=1)[bent]
    about, of_bent = without_folds(p, of, about, of[bent])
    corners = np.concatenate([p[origin[:, None] + fan], about])
    of_part = np.concatenate([of[origin], of_bent])
    order = np.argsort(of_part, kind="stable")
    return corners[order], of_part[order]


_MAX_EDGE_DEVIATION = 3e-3
"""Largest deviation, relative to a facet, of an edge that is treated as straight."""
_OFFSET = 1e-2
"""Largest distance along the faces of nodes that lie opposite, relative to the facet."""
_MARGIN = 0.1
"""Margin round a facet, relative to it, in which outlines are resolved as finely as inside."""
_REACH = 1.25
"""Radius, relative to that of its image, of the region opposite to a facet that is searched."""
_EDGE_SEGMENTS = 4
"""Number of segments of a curved edge."""
_NEARBY = (-0.75, 1.75)
"""Parameters in which the extended map of a facet must not fold over."""
_LEAST_STRETCH = 0.1
"""Smallest Jacobian of the extended map of a facet that is used, relative to that of the facet."""
_CORNERS = {
    "quadrilateral": np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=float),
    "triangle": np.array([(0, 0), (1, 0), (0, 1)], dtype=float),
}
"""Corners of a facet in anticlockwise order."""
_SIDES = {
    "quadrilateral": np.array([(0, 1, 0), (1, -1, 0), (0, 0, 1), (1, 0, -1)], dtype=float),
    "triangle": np.array([(0, 1, 0), (0, 0, 1), (1, -1, -1)], dtype=float),
}
"""Distances ``a + b t_0 + c t_1`` from the sides of a facet, positive inside."""


@lru_cache(maxsize=16)
def parts_opposite(face_1: Surface, face_2: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Parts of the facets of body 1 that lie opposite to a facet of body 2.

    The results for the last faces are cached: the error estimate uses coarser rules on them.

    Returns
    -------
    facet : ndarray of int, shape (n,)
        Facet of body 1.
    corners : ndarray, shape (n, 4, 2)
        Corners of each part, in parameters of the facet, anticlockwise; the last two of a triangle
        coincide.
    """
    same = _coinciding(face_1, face_2)
    first, second = _candidates(face_1, face_2)
    chosen = (same[first] < 0) | (same[first] == second)
    polygons, first = _outlines_in(face_1, face_2, first[chosen], second[chosen], same)
    for side in range(len(_SIDES[face_1.kind])):
        polygons = cut(polygons, _heights(face_1.kind, polygons.points)[:, side])
    corners, of = divided(tidied(polygons), face_1.kind)
    return first[of], corners


def _candidates(face_1: Surface, face_2: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of a facet of body 1 and one of body 2 near the points opposite to it."""
    places = lattice(2, face_1.kind)
    pairs = opposite(face_1, *face_1.on_each(places), face_2)
    points = face_2.points(pairs.facet, pairs.t).reshape(len(face_1.nodes), -1, 3)
    centres = points.mean(axis=1)
    radii = np.linalg.norm(points - centres[:, None], axis=2).max(axis=1)
    first, second = face_2.tree.touching(centres, _REACH * np.maximum(radii, face_1.tree.radii))
    cosine = np.einsum("ni,ni->n", face_1.middle_normals[first], face_2.middle_normals[second])
    facing = cosine <= MAX_FACING_COSINE
    return first[facing], second[facing]


def _coinciding(face_1: Surface, face_2: Surface) -> np.ndarray:
    """Facet of body 2 whose nodes lie opposite to those of each of body 1, (n_facets_1,).

    -1 if there is none. Gaps up to the length of a facet do not matter.
    """
    if face_1.nodes.shape[1:] != face_2.nodes.shape[1:]:
        return np.full(len(face_1.nodes), -1)
    _, near = cKDTree(face_2.nodes.mean(axis=1)).query(face_1.nodes.mean(axis=1))
    apart = face_1.nodes[:, :, None] - face_2.nodes[near][:, None]
    normals = face_1.middle_normals[:, None, None]
    gap = np.sum(apart * normals, axis=3, keepdims=True)
    off = np.linalg.norm(apart - gap * normals, axis=3).min(axis=2).max(axis=1)
    opposite = (off < _OFFSET * face_1.lengths) & (np.abs(gap).min(axis=(1, 2, 3)) < face_1.lengths)
    return np.where(opposite, near, -1)


def _outlines_in(
    face_1: Surface, face_2: Surface, first: np.ndarray, second: np.ndarray, same: np.ndarray
) -> tuple[Polygons, np.ndarray]:
    """Outlines of facets of body 2 in the parameters of facets of body 1, without redundant points.

    Facets with the same nodes have the same outline; it is not searched, as parameters extended
    beyond the edges of slender curved facets are ambiguous.

    Parameters
    ----------
    face_1, face_2 : Surface
    first, second : ndarray of int, shape (n,)
        Pairs of facets.
    same : ndarray of int, shape (n_facets_1,)
        See `_coinciding`.

    Returns
    -------
    polygons : Polygons
        Anticlockwise.
    first : ndarray of int, shape (n_polygons,)
        Facet of body 1.
    """
    points, normals, softness = (column[second] for column in _outlines(face_2))
    t = face_1.flattened.parameters(first[:, None, None], points)
    facing = -face_1.middle_normals[first][:, None, None]
    opposed = np.abs(normals - facing).max(axis=(1, 2, 3), initial=0.0) < TOLERANCE
    parallel = face_1.flat[first] & opposed
    near = _heights(face_1.kind, t).max(axis=(1, 2)) > -np.where(parallel, 0.0, 0.5)[:, None]
    alike = same[first] == second
    near = near.all(axis=1) | alike
    first, second, t, parallel, alike = (v[near] for v in (first, second, t, parallel, alike))
    if alike.any():  # of one kind
        t[alike] = _own_outlines(face_1, face_2, first[alike], second[alike])
    close = np.all((t > -1) & (t < 2), axis=-1)  # points farther away need no accuracy
    close[parallel | alike] = False
    on = np.broadcast_to(first[:, None, None], close.shape)[close]
    t[close] = _opposite_within(face_1, on, *(v[near][close] for v in (points, normals, softness)))
    t = _snapped(t, face_1.kind)
    kept = _necessary_points(t)
    polygons = Polygons(t[:, :, :-1][kept], np.nonzero(kept)[0])
    return anticlockwise(polygons), first


def _outlines(face: Surface) -> tuple[np.ndarray, ...]:
    """Points along the edges of facets from corner to corner, (n, n_edges, steps + 1, 3) [m].

    With the smooth normals there, and the softness of the body, (n, n_edges, steps + 1) [1/Pa].
    """
    ring = _CORNERS[face.kind]
    part = np.arange(_EDGE_SEGMENTS + 1)[:, None] / _EDGE_SEGMENTS
    t = ring[:, None] + part * (np.roll(ring, -1, axis=0) - ring)[:, None]
    shape = (len(face.nodes), len(ring), _EDGE_SEGMENTS + 1)
    facet, at = face.on_each(t.reshape(-1, 2))
    points, normals = face.points(facet, at), face.smooth_normals(facet, at)[0]
    softness = face.softness_at(facet).reshape(shape)
    return points.reshape(*shape, 3), normals.reshape(*shape, 3), softness


def _own_outlines(
    face_1: Surface, face_2: Surface, first: np.ndarray, second: np.ndarray
) -> np.ndarray:
    """Points as of `_outlines` of facets of body 2, in parameters of ones with the same nodes."""
    ring = _CORNERS[face_1.kind]
    corners, others = (
        face.points(np.repeat(facets, len(ring)), np.tile(ring, (len(facets), 1)))
        for face, facets in ((face_1, first), (face_2, second))
    )
    shape = (len(first), len(ring), 3)
    apart = others.reshape(shape)[:, :, None] - corners.reshape(shape)[:, None]
    start = ring[np.linalg.norm(apart, axis=3).argmin(axis=2)]
    part = np.arange(_EDGE_SEGMENTS + 1)[:, None] / _EDGE_SEGMENTS
    return start[:, :, None] + part * (np.roll(start, -1, axis=1) - start)[:, :, None]


def _opposite_within(face_1: Surface, facet: np.ndarray, points, normals, softness) -> np.ndarray:
    """Parameters, on facets extended beyond their edges, opposite to points, shape (n, 2)."""
    start = _on_extended(face_1, points, facet, None)
    return opposite_parameters(points, normals, softness, face_1, *start, _on_extended)[1]


def _on_extended(face: Surface, points, facet: np.ndarray, _) -> tuple[np.ndarray, np.ndarray]:
    """Closest points on given facets extended beyond their edges.

    Always from their flat approximation: far out a curved facet may be closest at other places.
    Facets whose map folds over near them are extended by its linearisation at the closest point.
    """
    start = face.flattened.parameters(facet, points)
    t = within(face, points, facet, start, bounds=(-np.inf, np.inf))
    folds = np.flatnonzero(_folding(face)[facet])
    if len(folds):
        points, facet_ = points[folds], facet[folds]
        on = inside(face, points, facet_, face.inside(start[folds]))
        places, tangents = face.points_and_tangents(facet_, on)
        square = np.einsum("nki,nli->nkl", tangents, tangents)
        along = np.einsum("nki,ni->nk", tangents, points - places)
        t[folds] = on + np.linalg.solve(square, along[..., None])[..., 0]
    return facet, t


@lru_cache(maxsize=2)
def _folding(face: Surface) -> np.ndarray:
    """Mask of facets, flat or curved, whose map folds over near them, (n_facets,).

    The Jacobian of a bilinear map is smallest at corners, that of a curved facet anywhere.
    """
    steps = np.linspace(*_NEARBY, 2 * face.order)
    facet, t = face.on_each(np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2))
    first, second = face.tangents(facet, t).swapaxes(0, 1)
    outward = face.middle_normals * face.outward[:, None]
    size = np.einsum("ni,ni->n", np.cross(first, second), outward[facet])
    size = size.reshape(len(face.nodes), -1)
    return size.min(axis=1) < _LEAST_STRETCH * size.mean(axis=1)


def _heights(kind: str, t: np.ndarray) -> np.ndarray:
    """Distances of parameters (..., 2) from the sides of a facet, shape (..., n_sides)."""
    return _SIDES[kind][:, 0] + t @ _SIDES[kind][:, 1:].T


def _snapped(t: np.ndarray, kind: str) -> np.ndarray:
    """Parameters (..., 2) moved to sides of the facet that they are on up to rounding."""
    for side in (0.0, 1.0):
        t = np.where(np.abs(t - side) < TOLERANCE, side, t)
    if kind == "triangle":
        beyond = t.sum(axis=-1, keepdims=True) - 1.0
        t = np.where((np.abs(beyond) < TOLERANCE) & (t > 0.5), t - beyond, t)
    return t


def _necessary_points(edges: np.ndarray) -> np.ndarray:
    """Mask of the outline points (n, n_edges, steps + 1, 2) to keep, (n, n_edges, steps).

    For each edge: its first corner, the points next to its intersections with the unit square, and
    the points inside if it is curved. Two facets with a common edge keep the same points.
    """
    low, high = (bound(edges[:, :, :-1], edges[:, :, 1:]) for bound in (np.minimum, np.maximum))
    enters = np.all((low < 1 + _MARGIN) & (high > -_MARGIN), axis=-1)
    steps = enters.shape[-1]
    first, last = enters.argmax(axis=-1), steps - enters[..., ::-1].argmax(axis=-1)
    start, end = (np.take_along_axis(edges, k[..., None, None], axis=2) for k in (first, last))
    along, from_start = end - start, edges - start
    off = along[..., 0] * from_start[..., 1] - along[..., 1] * from_start[..., 0]
    k = np.arange(steps + 1)
    inside = (k > first[..., None]) & (k < last[..., None])
    length = np.maximum(np.linalg.norm(along, axis=-1), TOLERANCE)
    bent = np.max(inside * np.abs(off) / length, axis=-1) > _MAX_EDGE_DEVIATION
    crossed = enters.any(axis=-1)
    ends = crossed[..., None] & ((k == first[..., None]) | (k == last[..., None]))
    return ((k == 0) | ends | (crossed & bent)[..., None] & inside)[..., :-1]
