"""Polygon clipping of opposite surface facets, for the common refinement of two surfaces.

All operations are done in the parameters of a facet of body 1, a unit square: the outlines of the
facets of body 2 are mapped to it at the points opposite to them (see `common_face`), and clipped by
its sides (Sutherland and Hodgman, Commun. ACM 17 (1974) 32). Shared edges of facets of body 2 have
the same image, so that the parts adjoin without gaps, on curved facets too.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from .common_face import MAX_FACING_COSINE, opposite_parameters
from .face import Surface
from .projection import within

_TOLERANCE = 1e-9
"""Relative size of a facet below which corners coincide with each other or with a side."""
_MAX_EDGE_DEVIATION = 3e-3
"""Largest deviation, relative to a facet, of an edge that is treated as straight."""
_MARGIN = 0.1
"""Margin round a facet, relative to it, in which outlines are resolved as finely as inside."""
_EDGE_SEGMENTS = 4
"""Number of segments of a curved edge."""
_CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))
"""Corners of a facet in anticlockwise order."""


@lru_cache(maxsize=1)
def parts_opposite(face_1: Surface, face_2: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Parts of the facets of body 1 that lie opposite to a facet of body 2.

    The result for the last two faces is cached: the error estimate uses a finer rule on them.

    Returns
    -------
    facet : ndarray of int, shape (n,)
        Facet of body 1.
    corners : ndarray, shape (n, 4, 2)
        Corners of each part, in parameters of the facet, anticlockwise; the last two of a triangle
        coincide.
    """
    facets, parts, outlines = [], [], _outlines(face_2)
    for facet in range(len(face_1.nodes)):
        facing = face_2.middle_normals @ face_1.middle_normals[facet] <= MAX_FACING_COSINE
        for ring in _nearby_outlines(face_1, facet, *(column[facing] for column in outlines)):
            pieces = _quadrilaterals(_clipped(ring))
            facets += [facet] * len(pieces)
            parts += pieces
    return np.array(facets, dtype=np.int64), np.array(parts).reshape(-1, 4, 2)


def _outlines(face: Surface) -> tuple[np.ndarray, ...]:
    """Points along the edges of facets from corner to corner, (n, 4, steps + 1, 3) [m].

    With the smooth normals there, and the softness of the body, shape (n, 4, steps + 1) [1/Pa].
    """
    ring = np.array(_CORNERS, dtype=float)
    part = np.arange(_EDGE_SEGMENTS + 1)[:, None] / _EDGE_SEGMENTS
    t = ring[:, None] + part * (np.roll(ring, -1, axis=0) - ring)[:, None]
    shape = (len(face.nodes), 4, _EDGE_SEGMENTS + 1)
    facet, at = face.on_each(t.reshape(-1, 2))
    points, normals = face.points(facet, at), face.smooth_normals(facet, at)[0]
    softness = face.softness_at(facet).reshape(shape)
    return points.reshape(*shape, 3), normals.reshape(*shape, 3), softness


def _nearby_outlines(face_1: Surface, facet: int, *outlines: np.ndarray) -> list[np.ndarray]:
    """Outlines near a facet of body 1 in its parameters, without redundant points, each (n, 2)."""
    flat = face_1.flattened.only(facet)
    points, normals, softness = outlines
    t = flat.parameters(points.reshape(-1, 3)).reshape(*softness.shape, 2)
    opposed = np.abs(normals + face_1.middle_normals[facet]).max(initial=0.0) < _TOLERANCE
    parallel = face_1.flat[facet] and opposed
    margin = 0.0 if parallel else 0.5
    near = (t.min(axis=(1, 2)) < 1 + margin) & (t.max(axis=(1, 2)) > -margin)
    chosen = near.all(axis=1)
    t = t[chosen]
    if not parallel and len(t):
        close = np.all((t > -1) & (t < 2), axis=-1)  # points farther away need no accuracy
        columns = (column[chosen][close] for column in outlines)
        t[close] = _opposite_within(face_1, facet, *columns)
    for side in (0.0, 1.0):
        t[np.abs(t - side) < _TOLERANCE] = side
    kept = _necessary_points(t)
    rings = [edges[:, :-1][chosen] for edges, chosen in zip(t, kept, strict=True)]
    # seen from body 1 the facets of body 2 have either orientation
    return [ring if _area(ring) > 0 else ring[::-1] for ring in rings]


def _opposite_within(face_1: Surface, facet: int, points, normals, softness) -> np.ndarray:
    """Parameters, on a facet extended beyond its edges, opposite to points, shape (n, 2)."""

    def locate(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        start = face_1.flattened.only(facet).parameters(points)[:, 0]
        on = np.full(len(points), facet)
        return on, within(face_1, points, on, start, bounds=(-np.inf, np.inf))

    return opposite_parameters(points, normals, softness, face_1, *locate(points), locate)[1]


def _necessary_points(edges: np.ndarray) -> np.ndarray:
    """Mask of the outline points (n, 4, steps + 1, 2) to keep, shape (n, 4, steps).

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
    length = np.maximum(np.linalg.norm(along, axis=-1), _TOLERANCE)
    bent = np.max(inside * np.abs(off) / length, axis=-1) > _MAX_EDGE_DEVIATION
    crossed = enters.any(axis=-1)
    ends = crossed[..., None] & ((k == first[..., None]) | (k == last[..., None]))
    return ((k == 0) | ends | (crossed & bent)[..., None] & inside)[..., :-1]


def _area(rings: np.ndarray) -> np.ndarray:
    """Areas of polygons (..., n, 2), positive anticlockwise."""
    following = np.roll(rings, -1, axis=-2)
    across = rings[..., 0] * following[..., 1] - rings[..., 1] * following[..., 0]
    return across.sum(axis=-1) / 2


def _clipped(ring: np.ndarray) -> np.ndarray:
    """Part of a polygon within the unit square, without redundant corners, shape (n, 2)."""
    for axis in (0, 1):
        for side, sense in ((0.0, 1.0), (1.0, -1.0)):
            ring = _cut(ring, sense * (ring[:, axis] - side))
    while len(ring) > 2:
        turn = np.abs(_turns(ring))
        if turn.min() > _TOLERANCE:
            return ring
        ring = np.delete(ring, turn.argmin(), axis=0)
    return ring[:0]


def _turns(ring: np.ndarray) -> np.ndarray:
    """Distance of each corner from the line of its neighbours, positive for a left turn."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    longer = np.maximum(np.hypot(*before.T), np.hypot(*after.T))
    return across / np.maximum(longer, _TOLERANCE)


def _cut(ring: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Part of a polygon where the interpolated height of its corners is nonnegative."""
    kept = []
    for k, h in enumerate(height):
        before = height[k - 1]
        if (h > 0 and before < 0) or (h < 0 and before > 0):
            part = before / (before - h)
            kept.append(ring[k - 1] + part * (ring[k] - ring[k - 1]))
        if h >= 0:
            kept.append(ring[k])
    return np.array(kept).reshape(-1, 2)


def _quadrilaterals(ring: np.ndarray) -> list[np.ndarray]:
    """Split a polygon into quadrilaterals, or into triangles about its mean if not convex."""
    if len(ring) < 3:
        return []
    if _turns(ring).min() < 0:
        middle, following = ring.mean(axis=0), np.roll(ring, -1, axis=0)
        return [np.array([middle, *side, side[1]]) for side in zip(ring, following, strict=True)]
    closed = np.vstack([ring, ring[-1:]])
    return [closed[[0, k, k + 1, k + 2]] for k in range(1, len(ring) - 1, 2)]
