"""Outlines of bodies that are meshed by rings around their contact."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .face_ends import depth_ends
from .quads import Sheet
from .rings import Outline, ring_levels, ringed

_SHOULDER = 0.66
"""Position on the flat where the diagonal of the rings in a disc ends, relative to the radius."""


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
    levels = ring_levels(outline, (ends[0], ends[-1]), depth, ratio)
    return ringed(outline, ends, depth_ends(rows[0], depth, rows[1]), levels)
