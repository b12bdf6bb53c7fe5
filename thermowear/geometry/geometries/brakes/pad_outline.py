"""Outline of a brake pad: sector of an annulus with rounded corners, and optional chamfers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

_STEPS = 20_000
"""Number of circles by which the face is integrated."""


@dataclass(frozen=True)
class PadOutline:
    """Outline of a pad, symmetric about the x-axis, about an axis along z.

    Attributes
    ----------
    inner, outer : float
        Radii of the pad [m].
    half_angle : float
        Half of the angle that it covers [rad].
    corner : float
        Radius of its corners, 0 for sharp ones [m].
    chamfer : float
        Distance of the edge of the flat face from the radial ends of the pad [m].
    """

    inner: float
    outer: float
    half_angle: float
    corner: float = 0.0
    chamfer: float = 0.0

    @property
    def corner_angles(self) -> tuple[float, float]:
        """Angles between the ends of the pad and the centres of the inner and outer corners [rad].

        NaN where a corner is larger than the pad.
        """
        c = self.corner
        ratios = np.array([c / (self.inner + c), c / max(self.outer - c, 1e-300)])
        with np.errstate(invalid="ignore"):
            first, second = np.arcsin(ratios)
        return float(first), float(second)

    @property
    def straight(self) -> tuple[float, float]:
        """Distances from the axis at which the straight ends begin and end [m]."""
        c = self.corner
        return math.sqrt(self.inner**2 + 2 * self.inner * c), math.sqrt(
            max(self.outer**2 - 2 * self.outer * c, 0.0)
        )

    def half_angle_at(self, radii: np.ndarray) -> np.ndarray:
        """Half of the angle that the flat face covers at distances from the axis, 0 beside it."""
        r = np.asarray(radii, dtype=float)
        inside = (r >= self.inner) & (r <= self.outer)
        safe = np.clip(r, self.inner, self.outer)
        angle = np.full(r.shape, self.half_angle)
        if self.corner > 0:
            centers = self.inner + self.corner, self.outer - self.corner
            first, last = self.straight
            for center, off, within in zip(
                centers, self.corner_angles, (safe < first, safe > last), strict=True
            ):
                cosine = (safe**2 + center**2 - self.corner**2) / (2 * safe * center)
                rounded = self.half_angle - off + np.arccos(np.clip(cosine, -1.0, 1.0))
                angle = np.where(within, rounded, angle)
        if self.chamfer > 0:
            angle = np.minimum(angle, self.half_angle - np.arcsin(self.chamfer / safe))
        return np.where(inside, np.maximum(angle, 0.0), 0.0)

    @cached_property
    def widest(self) -> float:
        """Largest half of the angle that the flat face covers [rad]."""
        return float(self.half_angle_at(np.linspace(self.inner, self.outer, _STEPS)).max())

    @cached_property
    def area(self) -> float:
        """Area of the flat face [m²]."""
        r, dr = self._circles
        return float((2 * self.half_angle_at(r) * r).sum() * dr)

    @cached_property
    def centroid(self) -> float:
        """Distance of the centroid of the flat face from the axis [m]."""
        r, dr = self._circles
        return float((2 * np.sin(self.half_angle_at(r)) * r**2).sum() * dr) / self.area

    @property
    def _circles(self) -> tuple[np.ndarray, float]:
        """Radii of circles across the pad, and their distance [m]."""
        dr = (self.outer - self.inner) / _STEPS
        return self.inner + dr * (np.arange(_STEPS) + 0.5), dr

    def duty(self, radii: np.ndarray) -> np.ndarray:
        """Fraction of a turn for which points of the disk are under the pad, shape (n,)."""
        return self.half_angle_at(radii) / math.pi

    @property
    def middle(self) -> float:
        """Radius of its mean circle [m]."""
        return (self.inner + self.outer) / 2

    @property
    def length(self) -> float:
        """Length along its mean circle [m]."""
        return (self.inner + self.outer) * self.half_angle

    @property
    def width(self) -> float:
        """Width along the radius [m]."""
        return self.outer - self.inner
