"""Cells between circles and rays, and bodies around a contact patch.

Angles are measured from the vertical, positive towards +x [rad].

The patch below the contact face is a tensor grid. Each ring adds a block under the patch and one
beside it (on both sides, or on the right only if a plane of symmetry bounds the body on the left).
Blocks meet on the diagonal. Where cells would become too slender, three of them are merged into one
across a ring.

Lengths along the face are arc lengths ("along"), depths are measured from the face into the body.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from .cells import Claim, Sheet, grid, ruled
from .divisions import (
    QUICKLY,
    check_count,
    depth_ends,
    divided_face,
    face_ends,
    growing,
    growing_from_both,
    growth,
    row_ratio,
)

_WIDEST = math.radians(12.0)
"""Largest angle of cells away from the contact: order 3 reproduces the area of a disk to 6e-7."""


@dataclass(frozen=True)
class Polar:
    """Polar coordinates about a centre.

    Attributes
    ----------
    height : float
        y of the centre [m].
    downwards : bool
        True if angles are measured from -y instead of +y.
    x : float
        x of the centre [m].
    """

    height: float = 0.0
    downwards: bool = False
    x: float = 0.0

    def sheet(self, angles: np.ndarray, radii: np.ndarray) -> Sheet:
        """Cells between rays and circles."""
        return Sheet(grid(angles, radii), self.place)

    def place(self, p: np.ndarray) -> np.ndarray:
        """Coordinates at angles and radii, both of shape (..., 2) [m]."""
        angle, radius = p[..., 0], p[..., 1]
        up = radius * np.cos(angle)
        y = self.height - up if self.downwards else self.height + up
        return np.stack([self.x + radius * np.sin(angle), y], axis=-1)

    def circle(self, radius: float, span: tuple[float, float] | None = None) -> Claim:
        """Predicate of edges with all nodes on a circle, and midpoints between two angles."""

        def claim(p):
            distance = np.hypot(p[..., 0] - self.x, p[..., 1] - self.height)
            on_circle = np.all(np.abs(distance - radius) < 1e-9 * radius, axis=1)
            if span is None:
                return on_circle
            x, y = p.mean(axis=1).T
            up = self.height - y if self.downwards else y - self.height
            turned = np.arctan2(x - self.x, up) - (span[0] + span[1]) / 2
            off_middle = np.abs((turned + math.pi) % (2 * math.pi) - math.pi)
            return on_circle & (off_middle < (span[1] - span[0]) / 2)

        return claim


@dataclass(frozen=True)
class Division:
    """Division of a face and the rows below it.

    Attributes
    ----------
    elements : int
        Number of elements in the contact.
    angles : ndarray
        Angles of the element ends, increasing [rad].
    first, ratio : float
        Size of the first row below the face [m], and ratio of successive rows.
    """

    elements: int
    angles: np.ndarray
    first: float
    ratio: float

    @property
    def span(self) -> tuple[float, float]:
        """Angles at the ends of the face [rad]."""
        return float(self.angles[0]), float(self.angles[-1])

    def all_round(self) -> np.ndarray:
        """Angles of the element ends around the whole circle, starting with the face."""
        return all_round([self])

    def beside(self, edge: float, room: float) -> np.ndarray:
        """Angles of elements from an end of the face to the middle of the arc beside it.

        They start as wide as the last one on the face and grow by `QUICKLY` to the widest there.

        Parameters
        ----------
        edge : float
            Angle of the last element on the face [rad].
        room : float
            Half the angle of the arc [rad].
        """
        widest = min(float(np.diff(self.angles).max()), _WIDEST)
        quick: list[float] = []
        size = min(edge, widest)
        while size < 0.9 * widest and sum(quick) + size < room / 2:
            quick.append(size)
            size = min(QUICKLY * size, widest)
        rest = growing(0.0, room - sum(quick), size, 1 / growth(self.elements), _WIDEST)
        return np.concatenate([quick, np.diff(rest)])

    def turned(self, angle: float) -> Division:
        """Same division farther round the circle."""
        return replace(self, angles=self.angles + angle)

    def sector(self, half: float) -> np.ndarray:
        """Angles of the element ends on an arc of half the angle `half` about the middle, 0."""
        right = self.beside(float(np.diff(self.angles)[-1]), half - self.span[1])
        left = self.beside(float(np.diff(self.angles)[0]), half + self.span[0])
        outer = self.span[1] + np.cumsum(right), self.span[0] - np.cumsum(left)
        return np.concatenate([outer[1][::-1], self.angles, outer[0]])

    def rows(self, start: float, end: float) -> np.ndarray:
        """Radii of the row ends of a ring, from its face to the other side [m]."""
        depth, largest = abs(end - start), max(start, end) * _WIDEST
        first = min(self.first, depth / 3)
        radii = growing(start, end, first, 1 / self.ratio, largest)
        return radii if start < end else radii[::-1]

    def layered(self, thicknesses: tuple[float, ...], length: float) -> list[np.ndarray]:
        """Depths of the row ends of each layer below a face; layer interfaces are row ends.

        Rows grow from the face and from both sides of every layer interface.

        Parameters
        ----------
        thicknesses : tuple of float
            Thicknesses of the layers from the face inwards [m].
        length : float
            Length of the face [m].
        """
        largest = max(length, sum(thicknesses)) * 3.0 / self.elements
        border = math.sqrt(self.first * largest)
        depth, size, layers = 0.0, self.first, []
        for thickness in thicknesses:
            rows = growing_from_both(0.0, thickness, (size, border), 1 / self.ratio, largest)
            layers.append(depth + rows)
            depth, size = depth + thickness, border
        return layers


def all_round(faces: Sequence[Division]) -> np.ndarray:
    """Angles of the element ends around the whole circle, starting with the first face.

    Parameters
    ----------
    faces : sequence of Division
        Faces on the circle, clockwise, with gaps between them.
    """
    first, parts = float(faces[0].angles[0]), []
    for face, following in zip(faces, [*faces[1:], faces[0]], strict=True):
        room = (following.span[0] - face.span[1]) % (2 * math.pi) / 2
        right = face.beside(float(np.diff(face.angles)[-1]), room)
        left = following.beside(float(np.diff(following.angles)[0]), room)
        outside = face.angles[-1] + np.cumsum(np.concatenate([right, left[::-1]]))
        turned = first + (face.span[0] - first) % (2 * math.pi) - face.span[0]
        parts.append(np.concatenate([face.angles, outside[:-1]]) + turned)
    return np.append(np.concatenate(parts), first + 2 * math.pi)


def complete(
    arc: tuple[float, float],
    radius: float,
    face: tuple[int, float],
    zone: tuple[float, float] | None = None,
) -> Division:
    """Division of a conforming face with sharp edges, in contact up to them or in a zone.

    Parameters
    ----------
    arc : tuple of float
        Angles at the edges [rad].
    radius : float [m]
    face : tuple of int and float
        Number of elements and grading, see `thermowear.case.tables.schema.Mesh.face`.
    zone : tuple of float, optional
        Angles of the contact edges if they lie inside the face [rad].
    """
    elements, grading = face
    angles = divided_face(*arc, elements, grading, zone)
    steps = np.diff(angles)
    if grading == 1:
        return Division(elements, angles, radius * float(steps.max()), row_ratio(elements))
    return Division(elements, angles, radius * float(steps.min()), min(3.0, 1 / grading))


def incomplete(
    zone: tuple[float, float], radius: float, face: tuple[int, float], limit: float
) -> Division:
    """Division of a face that is in contact in a zone only.

    Parameters
    ----------
    zone : tuple of float
        Angles of the contact edges, which are element ends [rad].
    radius, face
        See `complete`.
    limit : float
        Largest angle of the face, exceeded by a few degrees at most [rad].
    """
    elements, grading = face
    angles, largest = face_ends(zone, elements, grading, False, (-limit, limit))
    return Division(elements, angles, radius * largest, row_ratio(elements))


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
