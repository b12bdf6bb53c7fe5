"""Distribution of the wear of a body: in place, or over the track that passes the contact.

A face that stays in contact wears in place. Points of a strip, disk or drum are in contact for a
fraction of the time (duty factor); in a spatially fixed frame their wear rate is the local one,
``Z p^b``, averaged along the track. In all cases ``rate = share * local + reach (rows·local)``: a
fraction of the local rate, and means shared by several points.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

_SAME = 1e-3
"""Relative distance, by the width of a face, below which points lie on one circle."""
_ALIKE = 0.5
"""Smallest number of points on a circle of a polar mesh, relative to the mean number."""


class Distribution:
    """Map from the local wear rate of a body to its rate at the points.

    Attributes
    ----------
    share : float
        Fraction of the local rate that stays in place.
    """

    share: float = 0.0

    @property
    def rows(self) -> np.ndarray | None:
        """Weights of the k means shared by several points, shape (k, n)."""
        return None

    @property
    def varying_rows(self) -> np.ndarray | None:
        """`rows` without means that hardly change with the pressures."""
        return None

    @property
    def coverage(self) -> float:
        """Fraction of the worn area that is in contact at a time."""
        return self.share if self.rows is None else float(self.rows.sum(axis=1).mean())

    def reach(self, n: int) -> np.ndarray:
        """Weights of the k means at the n points, shape (n, k)."""
        return np.zeros((n, 0))

    def rate(self, local: np.ndarray) -> np.ndarray:
        """Wear rate at the points from the local one, shape (n,) or (n, columns) [m/s]."""
        own = self.share * local
        return own if self.rows is None else own + self.reach(len(local)) @ (self.rows @ local)

    def operator(self, n: int) -> np.ndarray:
        """Matrix of `rate`, shape (n, n)."""
        return self.rate(np.eye(n))


@dataclass(frozen=True)
class DutyFactor(Distribution):
    """Duty factor: each point is in contact for a fraction of the time (disk under a pad).

    Attributes
    ----------
    share : float
        Duty factor; for a pad on a disk, its angle over 2 π.
    """

    share: float


@dataclass(frozen=True)
class InPlace(DutyFactor):
    """Wear in place, with a duty factor of 1."""

    share: float = 1.0


@dataclass(frozen=True)
class UniformTrack(Distribution):
    """Uniform track: all points pass through the whole contact (strip, or drum under a shoe).

    The mean hardly changes with the pressures, whose resultant is the load.

    Attributes
    ----------
    row : ndarray, shape (n,)
        Length along the track of each contact point, over the length of the track.
    """

    row: np.ndarray

    @property
    def rows(self) -> np.ndarray:
        return self.row[None]

    def reach(self, n: int) -> np.ndarray:
        return np.ones((n, 1))


@dataclass(frozen=True)
class Rings(Distribution):
    """Rings of a disk under a pad: each point passes through the contact at its own radius.

    The mean along each circle is taken with hat functions of the radius, a partition of unity: the
    distribution conserves volume, is nonnegative, and keeps a uniform rate uniform.

    Attributes
    ----------
    hats : ndarray, shape (n, k)
        Values of the hat functions at the points.
    weights : ndarray, shape (n,)
        Areas of the points [m²].
    duty : float
        Fraction of a turn for which a point of the disk is under the pad, at every radius.
    """

    hats: np.ndarray
    weights: np.ndarray
    duty: float

    @cached_property
    def rows(self) -> np.ndarray:
        under = self.hats * self.weights[:, None]
        return self.duty * (under / under.sum(axis=0)).T

    @property
    def varying_rows(self) -> np.ndarray:
        return self.rows

    def reach(self, n: int) -> np.ndarray:
        return self.hats


def rings(radii: np.ndarray, weights: np.ndarray, duty: float) -> Rings:
    """Build the rings of a pad that subtends the same angle at every radius.

    The hat functions have their peaks at radii of points: on a polar mesh, with points on few
    circles, these circles; for scattered points, as many rings as points per ring.

    Parameters
    ----------
    radii : ndarray, shape (n,)
        Distances of the points from the axis [m].
    weights, duty
        As in `Rings`.
    """
    peaks, counts = _circles(radii)
    if counts.min() < _ALIKE * counts.mean() or len(peaks) == 1:
        levels = np.linspace(0.0, 1.0, max(2, round(len(radii) ** 0.5)))
        peaks = np.unique(np.quantile(radii, levels, method="nearest"))
    hats = np.array([np.interp(radii, peaks, unit) for unit in np.eye(len(peaks))]).T
    return Rings(hats, weights, duty)


def _circles(radii: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean radii of separate groups of points, increasing, and the number of points in each."""
    ordered = np.sort(radii)
    first = np.flatnonzero(np.diff(ordered, prepend=-np.inf) > _SAME * np.ptp(ordered))
    counts = np.diff(first, append=len(ordered))
    return np.add.reduceat(ordered, first) / counts, counts
