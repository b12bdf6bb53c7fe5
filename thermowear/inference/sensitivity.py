"""Sensitivity of outputs to uncertain inputs: Sobol indices, and swings of one input at a time.

First-order index (Saltelli et al., Comput. Phys. Commun. 181 (2010) 259) and total index (Jansen,
ibid. 117 (1999) 35) from outputs at the points of Saltelli's design, with f about its mean::

    S_i = ⟨f(B) (f(AB_i) - f(A))⟩/V,      T_i = ⟨(f(A) - f(AB_i))²⟩/(2 V)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .distributions import UncertainInput
from .propagation import INDEPENDENT
from .sampling import columns_of, values_at

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
