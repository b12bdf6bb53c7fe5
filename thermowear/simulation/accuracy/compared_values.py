"""Values that are compared between meshes: numbers, and profiles along the contact."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np


@dataclass(frozen=True)
class Number:
    """Single value.

    Attributes
    ----------
    value : float
    scale : float
        What its errors are relative to.
    """

    value: float
    scale: float

    def change(self, finer: Number) -> float:
        """Relative difference to the value on a finer mesh."""
        return abs(self.value - finer.value) / finer.scale


@dataclass(frozen=True, eq=False)
class WornHeights:
    """Heights of a worn face along the contact of a section.

    Attributes
    ----------
    position : ndarray, shape (n,)
        Arc length, which begins anew at each contact [m].
    height : ndarray, shape (n,) [m]
    weight : ndarray, shape (n,)
        Area, zero outside the contact [m²].
    """

    position: np.ndarray
    height: np.ndarray
    weight: np.ndarray

    def change(self, finer: WornHeights) -> float:
        """Largest difference in the contact except for its mean, relative to the range."""
        from scipy.interpolate import PchipInterpolator

        change = np.zeros_like(self.height)
        for own, other in zip(self._contacts(), finer._contacts(), strict=True):
            known = PchipInterpolator(finer.position[other], finer.height[other])
            ends = finer.position[other.start], finer.position[other.stop - 1]
            if self.weight[own].any():
                difference = self.height[own] - known(np.clip(self.position[own], *ends))
                change[own] = difference - np.average(difference, weights=self.weight[own])
        pressing = self.weight > 0
        return float(np.abs(change[pressing]).max(initial=0.0) / np.ptp(finer.height))

    def _contacts(self) -> list[slice]:
        """Points of each contact."""
        begins = np.flatnonzero(np.diff(self.position) <= 0) + 1
        ends = [0, *map(int, begins), len(self.position)]
        return [slice(*both) for both in pairwise(ends)]
