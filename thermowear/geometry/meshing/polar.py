"""Cells between circles and rays, refined below a contact arc.

Angles are measured from the vertical, positive towards +x [rad].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .cells import Claim, Sheet, grid
from .divisions import (
    QUICKLY,
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
