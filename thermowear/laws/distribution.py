"""Distribution of the wear of a body: in place, or over the track that passes the contact.

A face that stays in the contact wears where it is pressed. Points of a strip, disk or drum visit
the contact for a part of the time only; in a frame that does not move with them their wear rate is
the local one, ``Z p^b``, averaged over the way they go. In all cases
``rate = share * local + reach (rows·local)``: a part of the local rate, and means that several
points have in common.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Protocol

import numpy as np

_SAME = 1e-3
"""Relative distance, by the width of a face, below which points lie on one circle."""
_ALIKE = 0.5
"""Smallest number of points on a circle of a polar mesh, relative to the mean number."""


class Distribution(Protocol):
    """Map from the local wear rate of a body to its rate at the points.

    Attributes
    ----------
    share : float
        Part of the local rate that a point keeps.
    rows : ndarray, shape (k, n), or None
        Weights of the k means that points have in common.
    varying_rows : ndarray, shape (k, n), or None
        The same, without means that hardly change with the pressures.
    coverage : float
        Part of the worn area that is in the contact at a time.
    """

    @property
    def share(self) -> float: ...

    @property
    def rows(self) -> np.ndarray | None: ...

    @property
    def varying_rows(self) -> np.ndarray | None: ...

    @property
    def coverage(self) -> float: ...

    def reach(self, n: int) -> np.ndarray:
        """Weights of the k means at the n points, shape (n, k)."""
        ...

    def rate(self, local: np.ndarray) -> np.ndarray:
        """Wear rate at the points from the local one, shape (n,) [m/s]."""
        ...

    def operator(self, n: int) -> np.ndarray:
        """The matrix of `rate`, shape (n, n)."""
        ...


@dataclass(frozen=True)
class DutyFactor:
    """Each point is in the contact for a part of the time: a disk under a pad.

    Attributes
    ----------
    share : float
        Of a pad on a disk its angle over 2 π.
    """

    share: float
    rows: ClassVar[None] = None
    varying_rows: ClassVar[None] = None

    @property
    def coverage(self) -> float:
        return self.share

    def reach(self, n: int) -> np.ndarray:
        return np.zeros((n, 0))

    def rate(self, local: np.ndarray) -> np.ndarray:
        return self.share * local

    def operator(self, n: int) -> np.ndarray:
        return self.share * np.eye(n)


@dataclass(frozen=True)
class InPlace(DutyFactor):
    """The body wears where it is pressed."""

    share: float = 1.0


@dataclass(frozen=True)
class UniformTrack:
    """All points of a track pass through the whole contact: a strip, or a drum under a shoe.

    The mean hardly changes with the pressures: their sum is the load.

    Attributes
    ----------
    row : ndarray, shape (n,)
        Length along the track that each contact point stands for, over the length of the track.
    """

    row: np.ndarray
    share: ClassVar[float] = 0.0
    varying_rows: ClassVar[None] = None

    @property
    def rows(self) -> np.ndarray:
        return self.row[None]

    @property
    def coverage(self) -> float:
        return float(self.row.sum())

    def reach(self, n: int) -> np.ndarray:
        return np.ones((n, 1))

    def rate(self, local: np.ndarray) -> np.ndarray:
        return np.full(len(local), self.row @ local)

    def operator(self, n: int) -> np.ndarray:
        return np.tile(self.row, (n, 1))


@dataclass(frozen=True)
class Rings:
    """Points of a disk pass under a pad on circles, each through the contact at its own radius.

    The mean along each circle is taken with hats over the radius, whose weights add up to one at
    every point: what wears off locally is spread without loss, nowhere negative, and a uniform
    rate stays uniform.

    Attributes
    ----------
    hats : ndarray, shape (n, k)
        Values of the hats at the points.
    weights : ndarray, shape (n,)
        Areas of the points [m²].
    duty : float
        Part of a turn for which a point of the disk is under the pad, at every radius.
    """

    hats: np.ndarray
    weights: np.ndarray
    duty: float
    share: ClassVar[float] = 0.0

    @cached_property
    def rows(self) -> np.ndarray:
        under = self.hats * self.weights[:, None]
        return self.duty * (under / under.sum(axis=0)).T

    @property
    def varying_rows(self) -> np.ndarray:
        return self.rows

    @property
    def coverage(self) -> float:
        return self.duty

    def reach(self, n: int) -> np.ndarray:
        return self.hats

    def rate(self, local: np.ndarray) -> np.ndarray:
        return self.hats @ (self.rows @ local)

    def operator(self, n: int) -> np.ndarray:
        return self.hats @ self.rows


def rings(radii: np.ndarray, weights: np.ndarray, duty: float) -> Rings:
    """Rings of points under a pad that takes up the same angle at every radius.

    The hats have their peaks at radii of points. On a mesh in polar coordinates, whose points lie
    on few circles, these are the rings; among scattered points, as many as each has points.

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
    """Mean radii of groups of points that lie apart, increasing, and the number of points each."""
    ordered = np.sort(radii)
    first = np.flatnonzero(np.diff(ordered, prepend=-np.inf) > _SAME * np.ptp(ordered))
    counts = np.diff(first, append=len(ordered))
    return np.add.reduceat(ordered, first) / counts, counts
