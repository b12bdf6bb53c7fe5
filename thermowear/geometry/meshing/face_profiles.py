"""Meridians of annular faces: height over the radius, zero at the mean radius."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np


class FaceProfile(Protocol):
    """Meridian of a face.

    Attributes
    ----------
    order : int
        Geometric order of cells that follow it.
    """

    order: ClassVar[int]

    def height(self, radii: np.ndarray) -> np.ndarray:
        """Z at radii [m]."""

    def spaced(self, radii: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Map equally spaced radii to the nodes of cells that end at `columns` [m]."""


@dataclass(frozen=True)
class Straight:
    """Cone that rises outwards by `slope`; flat if it is 0."""

    middle: float
    slope: float
    order: ClassVar[int] = 1

    def height(self, radii):
        return (radii - self.middle) * self.slope

    def spaced(self, radii, columns):
        return radii


@dataclass(frozen=True)
class Arc:
    """Torus: an arc of the given radius, convex downwards [m]."""

    middle: float
    radius: float
    order: ClassVar[int] = 3

    def height(self, radii):
        return 2 * self.radius * np.sin(self._angle(radii) / 2) ** 2

    def spaced(self, radii, columns):
        # equal angles: points between the nodes then lie within 3e-4 h⁴/R³ of the arc
        after = np.clip(np.searchsorted(columns, radii, side="right"), 1, len(columns) - 1)
        start, end = columns[after - 1], columns[after]
        part = (radii - start) / (end - start)
        angle = (1 - part) * self._angle(start) + part * self._angle(end)
        return self.middle + self.radius * np.sin(angle)

    def _angle(self, radii):
        return np.arcsin((radii - self.middle) / self.radius)
