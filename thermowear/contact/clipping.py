"""Which parts of the facets of one surface lie opposite to which facets of another.

Everything happens in the parameters of a facet of body 1, a unit square: the facets of body 2 are
drawn into it by their outlines and clipped by its sides (Sutherland and Hodgman, Commun. ACM 17
(1974) 32). Facets of body 2 that share an edge have it at the same place, so the parts lie side by
side without gaps, on curved facets too.
"""

from __future__ import annotations

import numpy as np

from .projection import within
from .surface import Surface

_SAME = 1e-9
"""Of a facet: corners nearer to each other, or to a side, coincide."""
_STRAIGHT = 3e-3
"""Of a facet: an edge that is off a line by less is taken for straight."""
_AROUND = 0.1
"""Of a facet: how far round it outlines are drawn as carefully as within."""
_STEPS = 4
"""Points in which an edge is drawn that is not straight."""
_RING = ((0, 0), (1, 0), (1, 1), (0, 1))
"""Corners of a facet in order round it."""


def parts_opposite(face_1: Surface, face_2: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Parts of the facets of body 1 that have a facet of body 2 opposite to them.

    Returns
    -------
    facet : ndarray of int, shape (n,)
        Of body 1.
    corners : ndarray, shape (n, 4, 2)
        Of each part, in parameters of the facet, anticlockwise; a triangle's last two coincide.
    """
    facets, parts, outlines = [], [], _outlines(face_2)
    for facet in range(len(face_1.nodes)):
        facing = face_2.middle_normals @ face_1.middle_normals[facet] < 0
        for ring in _drawn(face_1, facet, outlines[facing]):
            pieces = _quadrilaterals(_clipped(ring))
            facets += [facet] * len(pieces)
            parts += pieces
    return np.array(facets, dtype=np.int64), np.array(parts).reshape(-1, 4, 2)


def _outlines(face: Surface) -> np.ndarray:
    """Points along the edges of each facet, corner to corner, shape (n, 4, steps + 1, 3) [m]."""
    ring = np.array(_RING, dtype=float)
    part = np.arange(_STEPS + 1)[:, None] / _STEPS
    t = ring[:, None] + part * (np.roll(ring, -1, axis=0) - ring)[:, None]
    count, places = len(face.nodes), t.reshape(-1, 2)
    facet = np.repeat(np.arange(count), len(places))
    return face.points(facet, np.tile(places, (count, 1))).reshape(count, 4, _STEPS + 1, 3)


def _drawn(face_1: Surface, facet: int, outlines: np.ndarray) -> list[np.ndarray]:
    """Outlines near a facet of body 1 in its parameters, without needless points, each (n, 2)."""
    flat, curved = face_1.flattened.only(facet), not face_1.flat[facet]
    t = flat.parameters(outlines.reshape(-1, 3)).reshape(outlines.shape[:-1] + (2,))
    margin = 0.5 if curved else 0.0
    near = (t.min(axis=(1, 2)) < 1 + margin) & (t.max(axis=(1, 2)) > -margin)
    t, outlines = t[near.all(axis=1)], outlines[near.all(axis=1)]
    if curved:
        close = np.all((t > -1) & (t < 2), axis=-1)  # farther away it does not matter where
        on = np.full(close.sum(), facet)
        t[close] = within(face_1, outlines[close], on, t[close], bounds=(-np.inf, np.inf))
    for side in (0.0, 1.0):
        t[np.abs(t - side) < _SAME] = side
    kept = _needed(t)
    rings = [edges[:, :-1][chosen] for edges, chosen in zip(t, kept, strict=True)]
    # seen from body 1 the facets of body 2 may run either way round
    return [ring if _area(ring) > 0 else ring[::-1] for ring in rings]


def _needed(edges: np.ndarray) -> np.ndarray:
    """Which points draw outlines (n, 4, steps + 1, 2) in the unit square, shape (n, 4, steps).

    Of each edge its first corner, the points next to where it enters or leaves the square, and
    those inside where it is not straight there. Two facets with a common edge keep the same ones.
    """
    low, high = (bound(edges[:, :, :-1], edges[:, :, 1:]) for bound in (np.minimum, np.maximum))
    enters = np.all((low < 1 + _AROUND) & (high > -_AROUND), axis=-1)
    steps = enters.shape[-1]
    first, last = enters.argmax(axis=-1), steps - enters[..., ::-1].argmax(axis=-1)
    start, end = (np.take_along_axis(edges, k[..., None, None], axis=2) for k in (first, last))
    along, from_start = end - start, edges - start
    off = along[..., 0] * from_start[..., 1] - along[..., 1] * from_start[..., 0]
    k = np.arange(steps + 1)
    inside = (k > first[..., None]) & (k < last[..., None])
    length = np.maximum(np.linalg.norm(along, axis=-1), _SAME)
    bent = np.max(inside * np.abs(off) / length, axis=-1) > _STRAIGHT
    crossed = enters.any(axis=-1)
    ends = crossed[..., None] & ((k == first[..., None]) | (k == last[..., None]))
    return ((k == 0) | ends | (crossed & bent)[..., None] & inside)[..., :-1]


def _area(rings: np.ndarray) -> np.ndarray:
    """Areas of polygons (..., n, 2), positive anticlockwise."""
    following = np.roll(rings, -1, axis=-2)
    across = rings[..., 0] * following[..., 1] - rings[..., 1] * following[..., 0]
    return across.sum(axis=-1) / 2


def _clipped(ring: np.ndarray) -> np.ndarray:
    """The part of a polygon within the unit square, without needless corners, shape (n, 2)."""
    for axis in (0, 1):
        for side, sense in ((0.0, 1.0), (1.0, -1.0)):
            ring = _cut(ring, sense * (ring[:, axis] - side))
    while len(ring) > 2:
        turn = np.abs(_turns(ring))
        if turn.min() > _SAME:
            return ring
        ring = np.delete(ring, turn.argmin(), axis=0)
    return ring[:0]


def _turns(ring: np.ndarray) -> np.ndarray:
    """How far each corner is off the line of its neighbours, positive to the left of it."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    longer = np.maximum(np.hypot(*before.T), np.hypot(*after.T))
    return across / np.maximum(longer, _SAME)


def _cut(ring: np.ndarray, height: np.ndarray) -> np.ndarray:
    """The part of a polygon where the height of its corners is not negative."""
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
    """A polygon in quadrilaterals and triangles: round a corner, or its middle if not convex."""
    if len(ring) < 3:
        return []
    if _turns(ring).min() < 0:
        middle, following = ring.mean(axis=0), np.roll(ring, -1, axis=0)
        return [np.array([middle, *side, side[1]]) for side in zip(ring, following, strict=True)]
    closed = np.vstack([ring, ring[-1:]])
    return [closed[[0, k, k + 1, k + 2]] for k in range(1, len(ring) - 1, 2)]
