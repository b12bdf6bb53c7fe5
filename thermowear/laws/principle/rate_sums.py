"""Rates at the contact points as sums over bodies, for the interior-point method."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np


class RateSum(Protocol):
    """Sum of rates that increase with the pressure at each point."""

    def at(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Value and derivative at positive pressures, shape (n,) each."""

    def terms(self, pressure: np.ndarray) -> np.ndarray:
        """Summands, shape (m, n)."""

    def slopes(self, pressure: np.ndarray) -> np.ndarray:
        """Derivatives of the summands, shape (m, n)."""

    def scaled(self, pressure: np.ndarray, value: float) -> RateSum:
        """Sum scaled by a pressure at each point and by a value."""


@dataclass(frozen=True)
class PowerSum:
    """Pointwise sum of powers ``Σ_i g_i p^e_i``.

    Attributes
    ----------
    factors : ndarray, shape (m, n)
    exponents : ndarray, shape (m,)
    """

    factors: np.ndarray
    exponents: np.ndarray

    def at(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Value and derivative at positive pressures, shape (n,) each."""
        terms = self.terms(pressure)
        return terms.sum(axis=0), self.exponents @ terms / pressure

    def terms(self, pressure: np.ndarray) -> np.ndarray:
        """Summands, shape (m, n)."""
        return self.factors * pressure ** self.exponents[:, None]

    def slopes(self, pressure: np.ndarray) -> np.ndarray:
        """Derivatives of the summands at positive pressures, shape (m, n)."""
        return self.exponents[:, None] * self.terms(pressure) / pressure

    def scaled(self, pressure: np.ndarray, value: float) -> PowerSum:
        """Sum scaled by a pressure at each point and by a value."""
        return PowerSum(self.terms(pressure) / value, self.exponents)


@dataclass(frozen=True)
class Common:
    """Means of rates shared by several points.

    Attributes
    ----------
    means : RateSum
        Summands of each mean at the points, shape (K, n).
    reach : ndarray, shape (n, K)
        Weights N of each mean at each point.
    """

    means: RateSum
    reach: np.ndarray

    @classmethod
    def none(cls, n: int) -> Common:
        """Empty set of means at n points."""
        return cls(PowerSum(np.zeros((0, n)), np.zeros(0)), np.zeros((n, 0)))

    def at(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Means (K,), and their derivatives at positive pressures, shape (K, n)."""
        return self.means.terms(pressure).sum(axis=1), self.means.slopes(pressure)

    def scaled(self, pressure: np.ndarray, value: float) -> Common:
        """Sum scaled by a pressure at each point and by a value."""
        return Common(self.means.scaled(pressure, value), self.reach)
