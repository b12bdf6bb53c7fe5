"""Samples of uncertain inputs, and the sensitivity of outputs to them.

Samples fill the unit cube (scipy.stats.qmc, scrambled, repeatable by their seed) and are mapped to
values by the inverse distribution functions of the inputs. An input of several dependent values,
such as calibrated parameters, has one column for each.

First-order index (Saltelli et al., Comput. Phys. Commun. 181 (2010) 259) and total index (Jansen,
ibid. 117 (1999) 35) from outputs at the points of Saltelli's design, with f about its mean::

    S_i = ⟨f(B) (f(AB_i) - f(A))⟩/V,      T_i = ⟨(f(A) - f(AB_i))²⟩/(2 V)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.stats import qmc

from .distributions import UncertainInput
from .propagation import INDEPENDENT

_NEAREST = 2.0**-33
"""Distance of quantiles from 0 and 1, where distributions may be infinite."""


@dataclass(frozen=True)
class Sample:
    """Sample of inputs.

    Attributes
    ----------
    values : ndarray, shape (n, p)
    requested : int
        Requested number of points; n is the next power of two for Sobol sequences.
    """

    values: np.ndarray
    requested: int

    @property
    def note(self) -> str:
        """Sentence on the number of points if it was rounded, else empty."""
        if len(self.values) == self.requested:
            return ""
        return (
            f"{self.requested} points rounded up to {len(self.values)}, a power of two, as Sobol "
            "sequences need"
        )


@dataclass(frozen=True)
class SaltelliDesign:
    """Points at which Sobol indices are estimated (Saltelli et al., 2010).

    Attributes
    ----------
    a, b : ndarray, shape (n, p)
        Independent samples.
    ab : ndarray, shape (d, n, p)
        Sample a with the columns of input i of d from b.
    requested : int
        Requested number n, rounded up to a power of two.
    """

    a: np.ndarray
    b: np.ndarray
    ab: np.ndarray
    requested: int

    @property
    def points(self) -> np.ndarray:
        """All points, a, b, then ab by input, shape (n (d + 2), p)."""
        return np.concatenate([self.a, self.b, *self.ab])

    def split(self, outputs: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Outputs (n (d + 2), k) at `points` as those of a (n, k), b (n, k) and ab (d, n, k)."""
        inputs, n, _ = self.ab.shape
        parts = np.asarray(outputs).reshape(inputs + 2, n, -1)
        return parts[0], parts[1], parts[2:]


def latin_hypercube(inputs: Sequence[UncertainInput], n: int, seed: int = 0) -> Sample:
    """Sample with one point in each of n strata of equal probability of every input."""
    cube = qmc.LatinHypercube(_columns(inputs), rng=np.random.default_rng(seed)).random(n)
    return Sample(values_at(inputs, cube), n)


def sobol_sequence(inputs: Sequence[UncertainInput], n: int, seed: int = 0) -> Sample:
    """Scrambled Sobol sequence; its length is the next power of two."""
    return Sample(values_at(inputs, _sobol(_columns(inputs), n, seed)), n)


def saltelli(inputs: Sequence[UncertainInput], n: int, seed: int = 0) -> SaltelliDesign:
    """Saltelli's design from a scrambled Sobol sequence in twice as many dimensions."""
    width = _columns(inputs)
    cube = _sobol(2 * width, n, seed)
    a, b = values_at(inputs, cube[:, :width]), values_at(inputs, cube[:, width:])
    mixed = np.repeat(a[None], len(inputs), axis=0)
    for i, columns in enumerate(columns_of(inputs)):
        mixed[i][:, columns] = b[:, columns]
    return SaltelliDesign(a, b, mixed, n)


def columns_of(inputs: Sequence[UncertainInput]) -> list[slice]:
    """Columns of each input in a sample."""
    ends = np.cumsum([0, *(one.size for one in inputs)])
    return [slice(int(begin), int(end)) for begin, end in pairwise(ends)]


def values_at(inputs: Sequence[UncertainInput], quantiles: np.ndarray) -> np.ndarray:
    """Values of inputs at quantiles, both of shape (n, p)."""
    quantiles = np.clip(quantiles, _NEAREST, 1 - _NEAREST)
    values = np.empty(quantiles.shape)
    for one, columns in zip(inputs, columns_of(inputs), strict=True):
        part = quantiles[:, columns]
        values[:, columns] = one.ppf(part)
    return values


def _columns(inputs: Sequence[UncertainInput]) -> int:
    if not inputs:
        raise ValueError("no uncertain inputs: at least one is needed")
    return sum(one.size for one in inputs)


def _sobol(dimensions: int, n: int, seed: int) -> np.ndarray:
    power = max(int(n) - 1, 0).bit_length()
    return qmc.Sobol(dimensions, rng=np.random.default_rng(seed)).random_base2(power)


_ROUNDING = 1e-12  # relative deviation of an output that counts as constant


@dataclass(frozen=True)
class SobolIndices:
    """Shares of d inputs in the variance of k outputs.

    Attributes
    ----------
    first, total : ndarray, shape (d, k)
        Share of an input alone, and with all its interactions; NaN for a constant output.
    first_interval, total_interval : ndarray, shape (2, d, k)
        Confidence intervals by bootstrap.
    rows : ndarray of int, shape (k,)
        Number of rows that were used.
    dropped : ndarray of int, shape (k,)
        Number of rows that were left out, as one of their points failed.
    """

    first: np.ndarray
    total: np.ndarray
    first_interval: np.ndarray
    total_interval: np.ndarray
    rows: np.ndarray
    dropped: np.ndarray


def sobol_indices(
    a: np.ndarray,
    b: np.ndarray,
    ab: np.ndarray,
    level: float = 0.95,
    resamples: int = 200,
    seed: int = 0,
) -> SobolIndices:
    """Sobol indices with confidence intervals.

    Parameters
    ----------
    a, b : ndarray, shape (n, k)
        Outputs at the points of A and B; NaN where a point failed.
    ab : ndarray, shape (d, n, k)
        Outputs at the points of AB_i.
    level : float
        Probability of the confidence intervals.
    resamples : int
        Number of bootstrap samples of the rows.
    """
    used = np.isfinite(a) & np.isfinite(b) & np.isfinite(ab).all(axis=0)
    terms = _terms(a, b, ab, used)
    first, total = _estimate(np.ones((1, len(used))), terms)
    rng = np.random.default_rng(seed)
    counts = rng.multinomial(len(used), np.full(len(used), 1 / len(used)), size=resamples)
    ends = [(1 - level) / 2, (1 + level) / 2]
    first_interval, total_interval = (
        np.quantile(each, ends, axis=0, method=INDEPENDENT) for each in _estimate(counts, terms)
    )
    rows = used.sum(axis=0)
    dropped = len(used) - rows
    return SobolIndices(first[0], total[0], first_interval, total_interval, rows, dropped)


@dataclass(frozen=True)
class _Terms:
    """Terms of the sums over rows; zero in rows that are left out."""

    used: np.ndarray  # (n, k)
    squares: np.ndarray  # (n, k), (a² + b²)/2
    least: np.ndarray  # (k,), variance by rounding
    first: np.ndarray  # (d, n, k)
    total: np.ndarray  # (d, n, k)


def _terms(a: np.ndarray, b: np.ndarray, ab: np.ndarray, used: np.ndarray) -> _Terms:
    count = np.maximum(used.sum(axis=0), 1)
    mean = (np.where(used, a, 0.0) + np.where(used, b, 0.0)).sum(axis=0) / (2 * count)
    a, b, ab = (np.where(used, each - mean, 0.0) for each in (a, b, ab))
    squares, least = (a**2 + b**2) / 2, (_ROUNDING * mean) ** 2
    return _Terms(used.astype(float), squares, least, b * (ab - a), (a - ab) ** 2 / 2)


def _estimate(weights: np.ndarray, terms: _Terms) -> tuple[np.ndarray, np.ndarray]:
    """Indices for weights (R, n) of the rows, each of shape (R, d, k)."""
    with np.errstate(invalid="ignore", divide="ignore"):
        count = weights @ terms.used
        variance = weights @ terms.squares / count
        scale = (count * np.where(variance > terms.least, variance, np.nan))[:, None]
        sums = (np.moveaxis(weights @ each, 0, 1) for each in (terms.first, terms.total))
        first, total = (each / scale for each in sums)
    return first, total


@dataclass(frozen=True)
class Swings:
    """Outputs with one input at a time at a low and a high quantile, the others at their medians.

    Attributes
    ----------
    base : ndarray, shape (k,)
        Outputs with all inputs at their medians.
    low, high : ndarray, shape (d, k)
    """

    base: np.ndarray
    low: np.ndarray
    high: np.ndarray

    @property
    def widths(self) -> np.ndarray:
        """Range of each output between both, shape (d, k), for the order in a tornado diagram."""
        return np.abs(self.high - self.low)


def swing_points(inputs: Sequence[UncertainInput], level: float = 0.9) -> np.ndarray:
    """Points of all medians, of low and of high quantiles of each column, shape (1 + 2 p, p).

    Parameters
    ----------
    level : float
        Probability between the low and the high quantile.
    """
    width = columns_of(inputs)[-1].stop
    quantiles = np.full((1 + 2 * width, width), 0.5)
    columns = np.arange(width)
    quantiles[1 + columns, columns] = (1 - level) / 2
    quantiles[1 + width + columns, columns] = (1 + level) / 2
    return values_at(inputs, quantiles)


def swings(outputs: np.ndarray) -> Swings:
    """Swings from outputs (1 + 2 p, k) at `swing_points`."""
    outputs = np.asarray(outputs)
    width = len(outputs) // 2
    return Swings(outputs[0], outputs[1 : 1 + width], outputs[1 + width :])
