"""Cells between circles and rays, fine below an arc of contact.

Angles are measured from the vertical, positive towards +x [rad].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .blocks import growing, growing_from_both, sizes
from .divided_face import divided_face
from .face_ends import face_ends, growth, row_ratio
from .quads import Sheet, grid

_WIDEST = math.radians(12.0)
"""Of cells away from the contact: cells of order 3 then have the area of a disk to 6e-7."""

_QUICKLY = 3.0
"""Ratio of elements that grow away from a graded edge of contact, where nothing presses."""


@dataclass(frozen=True)
class Polar:
    """Angle and radius about a centre on the line x = 0.

    Attributes
    ----------
    height : float
        y of the centre [m].
    downwards : bool
        Angles are measured from -y, not from +y.
    """

    height: float = 0.0
    downwards: bool = False

    def sheet(self, angles: np.ndarray, radii: np.ndarray) -> Sheet:
        """Cells between rays and circles."""
        return Sheet(grid(angles, radii), self.place)

    def place(self, p: np.ndarray) -> np.ndarray:
        """Coordinates at angles and radii, both of shape (..., 2) [m]."""
        angle, radius = p[..., 0], p[..., 1]
        up = radius * np.cos(angle)
        y = self.height - up if self.downwards else self.height + up
        return np.stack([radius * np.sin(angle), y], axis=-1)

    def on_circle(self, p: np.ndarray, radius: float) -> np.ndarray:
        """Which edges have all their nodes on a circle; nodes of shape (n_edges, order + 1, 2)."""
        distance = np.hypot(p[..., 0], p[..., 1] - self.height)
        return np.all(np.abs(distance - radius) < 1e-9 * radius, axis=1)

    def on_arc(self, p: np.ndarray, radius: float, span: tuple[float, float]) -> np.ndarray:
        """Which edges lie on a circle with their middle between two angles."""
        x, y = p.mean(axis=1).T
        up = self.height - y if self.downwards else y - self.height
        turned = np.arctan2(x, up) - (span[0] + span[1]) / 2
        beside = np.abs((turned + math.pi) % (2 * math.pi) - math.pi)
        return self.on_circle(p, radius) & (beside < (span[1] - span[0]) / 2)


@dataclass(frozen=True)
class Division:
    """How a face and the rows below it are divided.

    Attributes
    ----------
    elements : int
        In the contact.
    angles : ndarray
        At the ends of elements, increasing [rad].
    first, ratio : float
        Size of the first row below the face [m], and of each row to the one before.
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
        """Angles at the ends of elements, from the first one of the face once round the circle."""
        steps = np.diff(self.angles)
        left, right = self._beside(steps[0]), self._beside(steps[-1])
        beside = np.cumsum(np.concatenate([right, left[::-1]]))
        angles = np.concatenate([self.angles, self.angles[-1] + beside])
        angles[-1] = self.angles[0] + 2 * math.pi
        return angles

    def _beside(self, edge: float) -> np.ndarray:
        """Angles of elements from an end of the face to the point opposite to the face.

        They start as wide as the last one on the face, and grow quickly to the widest there.
        """
        first, last = self.span
        room = math.pi - (last - first) / 2
        widest = min(float(np.diff(self.angles).max()), _WIDEST)
        quick: list[float] = []
        size = min(edge, widest)
        while size < 0.9 * widest and sum(quick) + size < room / 2:
            quick.append(size)
            size = min(_QUICKLY * size, widest)
        rest = growing(0.0, room - sum(quick), size, 1 / growth(self.elements), _WIDEST)
        return np.concatenate([quick, sizes(rest)])

    def rows(self, start: float, end: float) -> np.ndarray:
        """Radii at the ends of rows of a ring, from its face to the other side [m]."""
        depth, largest = abs(end - start), max(start, end) * _WIDEST
        first = min(self.first, depth / 3)
        rows = sizes(growing(0.0, depth, first, 1 / self.ratio, largest))
        radii = start + math.copysign(1.0, end - start) * np.concatenate([[0.0], np.cumsum(rows)])
        radii[-1] = end
        return radii

    def layered(self, thicknesses: tuple[float, ...], length: float) -> list[np.ndarray]:
        """Depths at the ends of rows of each layer below a face; layers meet at ends of rows.

        Rows grow from the face and from both sides of every border between layers.

        Parameters
        ----------
        thicknesses : tuple of float
            From the face inwards [m].
        length : float
            Of the face [m].
        """
        largest = max(length, sum(thicknesses)) * 3.0 / self.elements
        border = math.sqrt(self.first * largest)
        depth, size, layers = 0.0, self.first, []
        for thickness in thicknesses:
            rows = growing_from_both(0.0, thickness, (size, border), 1 / self.ratio, largest)
            ends = depth + np.concatenate([[0.0], np.cumsum(sizes(rows))])
            depth, size = depth + thickness, border
            ends[-1] = depth
            layers.append(ends)
        return layers


def complete(
    arc: tuple[float, float],
    radius: float,
    face: tuple[int, float],
    zone: tuple[float, float] | None = None,
) -> Division:
    """Division of a face with sharp edges that fits the other one, and may touch up to them.

    Parameters
    ----------
    arc : tuple of float
        Angles at the edges [rad].
    radius : float [m]
    face : tuple of int and float
        Elements and grading, see `thermowear.case.tables.schema.Mesh.face`.
    zone : tuple of float, optional
        Angles at the edges of the contact where it ends inside the face [rad].
    """
    elements, grading = face
    steps = sizes(divided_face(*arc, elements, grading, zone))
    angles = arc[0] + np.concatenate([[0.0], np.cumsum(steps)])
    angles[-1] = arc[1]
    if grading == 1:
        return Division(elements, angles, radius * float(steps.max()), row_ratio(elements))
    return Division(elements, angles, radius * float(steps.min()), min(3.0, 1 / grading))


def incomplete(
    zone: tuple[float, float], radius: float, face: tuple[int, float], limit: float
) -> Division:
    """Division of a face that touches in a zone only.

    Parameters
    ----------
    zone : tuple of float
        Angles at the edges of the contact, where elements end [rad].
    radius, face
        As in `complete`.
    limit : float
        Angle beyond which the face does not go on, but for a few degrees [rad].
    """
    elements, grading = face
    angles, largest = face_ends(zone, elements, grading, False, (-limit, limit))
    return Division(elements, angles, radius * largest, row_ratio(elements))
