"""Distribution of the wear of a body: in place, or over the track that passes the contact.

A face that stays in contact wears in place. Points of a strip, disk or drum are in contact for a
fraction of the time (duty factor); in a spatially fixed frame their wear rate is the local one,
``Z p^b``, averaged along the track. In all cases ``rate = share * local + reach (rows·local)``: a
fraction of the local rate, and means shared by several points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

_SAME = 1e-3
"""Relative distance, by the width of a face, below which points lie on one circle."""
_GRAZING = 1 - 1e-10
"""Largest cosine of half the angle under a pin, for points at its edge."""
_ALIKE = 0.5
"""Smallest number of points on a circle of a polar mesh, relative to the mean number."""


class Means(NamedTuple):
    """Means of a rate that are shared by several points.

    Attributes
    ----------
    rows : ndarray, shape (k, n)
        Weights of the points in each mean.
    reach : ndarray, shape (n, k)
        Weights of the means at each point.
    varies : bool
        True if the means depend on the distribution of the pressures, not only on the load.
    coverage : float or ndarray, shape (n,)
        Fraction of the worn area that is in contact at a time, at each point.
    """

    rows: np.ndarray
    reach: np.ndarray
    varies: bool
    coverage: float | np.ndarray


@dataclass(frozen=True)
class Distribution:
    """Map from the local wear rate of a body to its rate at the n points.

    Attributes
    ----------
    share : float or ndarray, shape (n,)
        Fraction of the local rate that stays in place; without means, the duty factor: the fraction
        of the time for which each point is in contact (disk under a pad: its angle over 2 π).
    means : Means or None
    """

    share: float | np.ndarray = 0.0
    means: Means | None = None

    @property
    def coverage(self) -> float | np.ndarray:
        """Fraction of the worn area that is in contact at a time, at each of n points or at all."""
        return self.share if self.means is None else self.means.coverage

    def rate(self, local: np.ndarray) -> np.ndarray:
        """Wear rate at the points from the local one, shape (n,) or (n, columns) [m/s]."""
        own, means = self.share * local, self.means
        return own if means is None else own + means.reach @ (means.rows @ local)


@dataclass(frozen=True)
class InPlace(Distribution):
    """Wear in place, with a duty factor of 1."""

    share: float | np.ndarray = 1.0


IN_PLACE = InPlace()


def joined_distributions(
    each: Sequence[Distribution], counts: Sequence[int], tracks: Sequence[str] = ()
) -> Distribution:
    """Distribution of the wear at the points of several interfaces, see `joined_laws`.

    Parameters
    ----------
    each : sequence of Distribution
    counts : sequence of int
        Number of points of each interface.
    tracks : sequence of str
        Name of the track that passes each interface, by default one of its own. A track that passes
        several of them wears by the sum of what each causes, for the points of all of them.
    """
    if len(each) == 1 or all(isinstance(one, InPlace) for one in each):
        return each[0]
    share = np.concatenate(
        [np.broadcast_to(one.share, n) for one, n in zip(each, counts, strict=True)]
    )
    coverage = np.zeros_like(share)
    ends, shared = np.cumsum(counts), dict[str, list[tuple[Distribution, slice]]]()
    for k, (one, end, n) in enumerate(zip(each, ends, counts, strict=True)):
        shared.setdefault(tracks[k] if tracks else str(k), []).append((one, slice(end - n, end)))
    rows, reach, varies = [], [], False
    for group in shared.values():
        for _, points in group:
            coverage[points] = sum(one.coverage for one, _ in group)
        means = [(one.means, points) for one, points in group if one.means is not None]
        if means:
            rows.append(np.zeros((len(means[0][0].rows), len(share))))
            reach.append(np.zeros((len(share), len(means[0][0].rows))))
        for known, points in means:
            rows[-1][:, points], reach[-1][points] = known.rows, known.reach
            varies |= known.varies
    if not rows:
        return Distribution(share)
    return Distribution(share, Means(np.vstack(rows), np.hstack(reach), varies, coverage))


def uniform_track(lengths: np.ndarray) -> Distribution:
    """Uniform track: all points pass through the whole contact (strip, or drum under a shoe).

    The mean hardly changes with the pressures, whose resultant is the load.

    Parameters
    ----------
    lengths : ndarray, shape (n,)
        Length along the track of each contact point, over the length of the track.
    """
    covered, even = float(lengths.sum()), np.ones((len(lengths), 1))
    return Distribution(0.0, Means(lengths[None], even, varies=False, coverage=covered))


def rings(radii: np.ndarray, weights: np.ndarray, duty: float | np.ndarray) -> Distribution:
    """Rings of a disk under a pad: each point passes through the contact at its own radius.

    The mean along each circle is taken with hat functions of the radius, a partition of unity: the
    distribution conserves volume, is nonnegative, and keeps a uniform rate uniform. Their peaks
    are at radii of points: on a polar mesh, with points on few circles, these circles; for
    scattered points, as many rings as points per ring.

    Parameters
    ----------
    radii : ndarray, shape (n,)
        Distances of the points from the axis [m].
    weights : ndarray, shape (n,)
        Areas of the points [m²].
    duty : float or ndarray, shape (n,)
        Fraction of a turn for which a point of the disk is under the pad, at every radius or at
        those of the points.
    """
    peaks, counts = _circles(radii)
    if counts.min() < _ALIKE * counts.mean() or len(peaks) == 1:
        levels = np.linspace(0.0, 1.0, max(2, round(len(radii) ** 0.5)))
        peaks = np.unique(np.quantile(radii, levels, method="nearest"))
    hats = np.array([np.interp(radii, peaks, unit) for unit in np.eye(len(peaks))]).T
    under = hats * weights[:, None]
    if np.ndim(duty) == 0:
        rows = duty * (under / under.sum(axis=0)).T
    else:
        rows = (under / (hats * (weights / duty)[:, None]).sum(axis=0)).T
    return Distribution(0.0, Means(rows, hats, varies=True, coverage=duty))


def round_duty(radii: np.ndarray, distance: float, radius: float) -> np.ndarray:
    """Fraction of a turn for which points of a disk are under a round pin, shape (n,).

    The circle of a point about the axis of the disk lies under the pin over an angle of
    ``2 arccos((r² + d² - a²) / 2 r d)``, by the law of cosines.

    Parameters
    ----------
    radii : ndarray, shape (n,)
        Distances r of the points from the axis of the disk [m].
    distance : float
        Distance d of the axis of the pin from that of the disk [m].
    radius : float
        Radius a of the pin [m].
    """
    cosine = (radii**2 + distance**2 - radius**2) / (2 * radii * distance)
    return np.arccos(np.clip(cosine, -1.0, _GRAZING)) / np.pi


def _circles(radii: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean radii of separate groups of points, increasing, and the number of points in each."""
    ordered = np.sort(radii)
    first = np.flatnonzero(np.diff(ordered, prepend=-np.inf) > _SAME * np.ptp(ordered))
    counts = np.diff(first, append=len(ordered))
    return np.add.reduceat(ordered, first) / counts, counts
