"""Structured mesh of a body around its contact: a fine patch, then rings that grow outwards.

The patch below the contact face is a tensor grid. Each ring adds a block under the patch and one
beside it (on both sides, or on the right only if a plane of symmetry bounds the body on the left).
Blocks meet on the diagonal. Where cells would become too slender, three of them are merged into one
across a ring.

Lengths along the face are arc lengths ("along"), depths are measured from the face into the body.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .cells import Sheet, ruled
from .divisions import check_count, depth_ends

_SHOULDER = 0.66
"""Position on the flat where the diagonal of the rings in a disc ends, relative to the radius."""

_SLENDER = 2.9
"""Ratio of ring width to cell size above which three cells are merged."""

_TALL = 5.4
"""Ratio above which they are merged in a narrower ring of their own."""

_IN_RING = 500
"""Number of cells of a ring, for an estimate of their total."""


class Outline(Protocol):
    """Shape of a body relative to its contact face.

    Attributes
    ----------
    reach : tuple of float
        `along` at the left and the right end of the body [m].
    depth : float
        Depth of the side opposite to the face [m].
    """

    @property
    def reach(self) -> tuple[float, float]: ...

    @property
    def depth(self) -> float: ...

    def face(self, along: np.ndarray) -> np.ndarray:
        """Points on the face, shape (..., 2) [m]."""

    def inside(self, along: np.ndarray, depth: np.ndarray) -> np.ndarray:
        """Corners of rings; on the body's boundary at `reach` and `depth`, shape (..., 2) [m]."""


@dataclass(frozen=True)
class Disc:
    """Lower half of a disc that touches the origin from above, an `Outline`.

    `along` is the arc length from the origin. Only x >= 0 if `half`.
    """

    radius: float
    half: bool

    @property
    def reach(self) -> tuple[float, float]:
        return (0.0 if self.half else -self.depth, self.depth)

    @property
    def depth(self) -> float:
        return math.pi / 2 * self.radius

    def face(self, along):
        angle = along / self.radius
        return self.radius * np.stack([np.sin(angle), 2 * np.sin(angle / 2) ** 2], axis=-1)

    def inside(self, along, depth):
        quarter = self.depth
        ends = ((along, _SHOULDER * self.radius), (depth, self.radius))
        bent = [v * (1 - (1 - end / quarter) * np.abs(v) / quarter) for v, end in ends]
        return np.stack(np.broadcast_arrays(*bent), axis=-1)


@dataclass(frozen=True)
class RectangularOutline:
    """Rectangle below y = 0, an `Outline`; `side` is the distance of its sides from x = 0."""

    side: float
    depth: float
    half: bool

    @property
    def reach(self) -> tuple[float, float]:
        return (0.0 if self.half else -self.side, self.side)

    def face(self, along):
        return np.stack([along, np.zeros_like(along)], axis=-1)

    def inside(self, along, depth):
        return np.stack(np.broadcast_arrays(along, -depth), axis=-1)


def ringed_body(
    outline: Outline, ends: np.ndarray, rows: Sequence[float], ratio: float
) -> list[Sheet]:
    """Cells of a body with given division of its contact face.

    Parameters
    ----------
    outline : Outline
    ends : ndarray
        Element ends of the contact face, along it [m].
    rows : sequence of float
        Size of the first row below the face [m], and ratio of successive rows.
    ratio : float
        Ratio of successive ring widths.
    """
    half = ends[0] == outline.reach[0]
    depth = min((ends[-1] - ends[0]) / (1 if half else 2), outline.depth / 2)
    levels = _ring_levels(outline, (ends[0], ends[-1]), depth, ratio)
    return _sheets(outline, ends, depth_ends(rows[0], depth, rows[1]), levels)


def _ring_levels(
    outline: Outline, face: tuple[float, float], depth: float, growth: float
) -> np.ndarray:
    """Rings from a patch to the end of a body, each about `growth` times the one before it.

    The patch covers `face` and extends to `depth`. A left end equal to that of `reach` is a plane
    of symmetry. Limits of the rings, shape (3, n + 1): `along` on the left and on the right, depth.
    """
    middle = face[0] if face[0] == outline.reach[0] else (face[0] + face[1]) / 2
    starts = np.array([middle - face[0], face[1] - middle, depth])
    ends = np.array([middle - outline.reach[0], outline.reach[1] - middle, outline.depth])
    largest = (growth - 1) * ends[ends > 0].min()
    steps = [_growing(a, b, growth, largest) for a, b in zip(starts, ends, strict=True)]
    count = max(map(len, steps))
    left, right, down = (np.pad(s, (0, count - len(s)), mode="edge") for s in steps)
    return np.array([middle - left, middle + right, down])


def _growing(start: float, end: float, growth: float, largest: float) -> np.ndarray:
    """Geometric sequence of distances from start to end, with steps up to `largest`."""
    if start == end:
        return np.array([start])
    check_count((end - start) / largest, _IN_RING)
    found = [start]
    while found[-1] < end:
        found.append(found[-1] + min((growth - 1) * found[-1], largest))
    if len(found) > 2 and end / found[-2] < found[-1] / end:
        found.pop()
    result = start + (np.array(found) - start) * (end - start) / (found[-1] - start)
    result[-1] = end
    return result


def _sheets(outline: Outline, face: np.ndarray, rows: np.ndarray, stack: np.ndarray) -> list[Sheet]:
    """Cells of the patch, with its element ends along the face and in depth, and of the rings."""
    inner = outline.inside(face[[0, -1]], rows[[-1, -1]])
    sheets = [ruled(outline.face, inner, face, rows / rows[-1])]
    parts = [np.linspace(0.0, 1.0, len(face)), rows / rows[-1], rows / rows[-1]]
    k = 0
    while k < stack.shape[1] - 1:
        left, right, depth = stack[:, k : k + 2]
        down, across = depth.mean(), (right - left).mean()
        widths = np.ptp(depth) / across, np.ptp(left) / down, np.ptp(right) / down
        slenderness = [w * (len(t) - 1) for w, t in zip(widths, parts, strict=True)]
        tall = [q for q, t in zip(slenderness, parts, strict=True) if q > _TALL and len(t) > 3]
        if tall:
            between = stack[:, k] + 3 / max(tall) * (stack[:, k + 1] - stack[:, k])
            stack = np.insert(stack, k + 1, between, axis=1)
            continue
        places = (
            _below(outline, left, right, depth),
            _beside(outline, left, depth),
            _beside(outline, right, depth),
        )
        for i, (q, place) in enumerate(zip(slenderness, places, strict=True)):
            if q > 0:
                parts[i], cells = _ring_block(parts[i], q >= _SLENDER)
                sheets.append(Sheet(cells, place))
        k += 1
    return sheets


def _below(outline: Outline, left, right, depth):
    """Block of a ring below the patch; parameters (s, t): outwards, from left to right."""

    def place(p):
        s, t = p[..., 0], p[..., 1, None]
        down = _linear(depth, s)
        first, last = (outline.inside(_linear(end, s), down) for end in (left, right))
        return (1 - t) * first + t * last

    return place


def _beside(outline: Outline, end, depth):
    """Block of a ring beside the patch; parameters (s, t): outwards, from the face inwards."""

    def place(p):
        s, t = p[..., 0], p[..., 1, None]
        along = _linear(end, s)
        return (1 - t) * outline.face(along) + t * outline.inside(along, _linear(depth, s))

    return place


def _linear(ends, s):
    return (1 - s) * ends[0] + s * ends[1]


def _ring_block(inner: np.ndarray, join: bool) -> tuple[np.ndarray, np.ndarray]:
    """Cells of a block of a ring in (s, t), and t at its element ends on the outside.

    Of those on the inside, at t = `inner`, three are merged into one for `join`.
    """
    n = len(inner) - 1
    triples = n // 3 if join else 0
    if n % 3 and triples % 2:
        triples -= 1  # the remainder stays in the middle, for symmetry
    before = (triples + 1) // 2
    rest = n - 3 * triples
    starts = [3 * i for i in range(before)]
    singles = list(range(3 * before, 3 * before + rest))
    starts += [3 * before + rest + 3 * i for i in range(triples - before)]
    kept = np.array(sorted([*starts, *singles, n]))
    outer = 0.5 * (inner[kept] + np.linspace(0.0, 1.0, len(kept)))
    at = {int(i): float(t) for i, t in zip(kept, outer, strict=True)}
    cells = [[(0, inner[i]), (0, inner[i + 1]), (1, at[i + 1]), (1, at[i])] for i in singles]
    for i in starts:
        cells += _three_to_one(inner[i : i + 4], at[i], at[i + 3])
    return outer, np.array(cells)


def _three_to_one(inner, first: float, last: float) -> list[list]:
    """Four cells between three elements on the inside and one on the outside."""
    ends = (inner[[0, -1]] + [first, last]) / 2
    parts = ((inner[1:3] - inner[0]) / (inner[3] - inner[0]) + np.array([1, 2]) / 3) / 2
    a, b = ((0.5, ends[0] + part * (ends[1] - ends[0])) for part in parts)
    p = [(0, t) for t in inner]
    low, high = (1, first), (1, last)
    return [[p[0], p[1], a, low], [p[1], p[2], b, a], [p[2], p[3], high, b], [a, b, high, low]]
