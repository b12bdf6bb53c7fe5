"""Distributions of uncertain inputs, given as engineers know them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Protocol

import numpy as np
from scipy import stats


class UncertainInput(Protocol):
    """Input with a distribution: one value, or `size` values that depend on each other."""

    @property
    def size(self) -> int: ...

    def ppf(self, quantiles: np.ndarray) -> np.ndarray:
        """Values at quantiles in (0, 1), both of shape (n, size)."""
        ...


class ScalarDistribution:
    """Distribution of one value, evaluated by scipy."""

    size: ClassVar[int] = 1

    @cached_property
    def scipy(self) -> Any:
        """Frozen distribution of scipy.stats."""
        raise NotImplementedError

    def ppf(self, quantiles) -> np.ndarray:
        """Values at quantiles in (0, 1), of the same shape."""
        return np.asarray(self.scipy.ppf(quantiles))

    @property
    def expected(self) -> float:
        """Mean of the value."""
        return float(self.scipy.mean())

    @property
    def spread(self) -> float:
        """Standard deviation of the value."""
        return float(self.scipy.std())


@dataclass(frozen=True)
class Normal(ScalarDistribution):
    """Normal distribution with a mean and a standard deviation."""

    mean: float
    deviation: float

    def __post_init__(self):
        _positive("standard deviation", self.deviation)

    @cached_property
    def scipy(self) -> Any:
        return stats.norm(self.mean, self.deviation)


@dataclass(frozen=True)
class TruncatedNormal(ScalarDistribution):
    """Normal distribution, limited to an interval; mean and deviation are those before."""

    mean: float
    deviation: float
    lower: float = -math.inf
    upper: float = math.inf

    def __post_init__(self):
        _positive("standard deviation", self.deviation)
        _ordered(self.lower, self.upper)

    @cached_property
    def scipy(self) -> Any:
        ends = [(end - self.mean) / self.deviation for end in (self.lower, self.upper)]
        return stats.truncnorm(*ends, self.mean, self.deviation)


@dataclass(frozen=True)
class LogNormal(ScalarDistribution):
    """Distribution of a value whose natural logarithm is normal.

    Attributes
    ----------
    median : float
    log_deviation : float
        Standard deviation of the natural logarithm.
    """

    median: float
    log_deviation: float

    def __post_init__(self):
        _positive("median", self.median)
        _positive("standard deviation of the logarithm", self.log_deviation)

    @classmethod
    def from_mean(cls, mean: float, deviation: float) -> LogNormal:
        """Distribution with a mean and a standard deviation of the value itself."""
        _positive("mean", mean)
        _positive("standard deviation", deviation)
        variance = math.log1p((deviation / mean) ** 2)
        return cls(mean * math.exp(-variance / 2), math.sqrt(variance))

    @classmethod
    def from_factor(cls, median: float, factor: float, level: float = 0.95) -> LogNormal:
        """Distribution with a probability `level` between median/factor and median·factor."""
        if factor <= 1:
            raise ValueError(f"factor {factor:g} about a median; must be above 1")
        return cls(median, math.log(factor) / float(stats.norm.ppf((1 + level) / 2)))

    @cached_property
    def scipy(self) -> Any:
        return stats.lognorm(self.log_deviation, scale=self.median)


@dataclass(frozen=True)
class Uniform(ScalarDistribution):
    """Uniform distribution between two values."""

    lower: float
    upper: float

    def __post_init__(self):
        _positive("width of the interval", self.upper - self.lower)

    @cached_property
    def scipy(self) -> Any:
        return stats.uniform(self.lower, self.upper - self.lower)


@dataclass(frozen=True)
class LogUniform(ScalarDistribution):
    """Distribution between two positive values whose logarithm is uniform."""

    lower: float
    upper: float

    def __post_init__(self):
        _positive("lower end", self.lower)
        _positive("width of the interval", self.upper - self.lower)

    @cached_property
    def scipy(self) -> Any:
        return stats.loguniform(self.lower, self.upper)


@dataclass(frozen=True)
class Triangular(ScalarDistribution):
    """Triangular distribution between two values, with its peak at the mode."""

    lower: float
    mode: float
    upper: float

    def __post_init__(self):
        _positive("width of the interval", self.upper - self.lower)
        if not self.lower <= self.mode <= self.upper:
            raise ValueError(
                f"mode {self.mode:g}; must be between {self.lower:g} and {self.upper:g}"
            )

    @cached_property
    def scipy(self) -> Any:
        width = self.upper - self.lower
        return stats.triang((self.mode - self.lower) / width, self.lower, width)


def _positive(what: str, number: float) -> None:
    if not (number > 0 and math.isfinite(number)):
        raise ValueError(f"{what} {number:g}; must be positive and finite")


def _ordered(lower: float, upper: float) -> None:
    if not lower < upper:
        raise ValueError(f"lower end {lower:g}; must be below the upper end {upper:g}")
