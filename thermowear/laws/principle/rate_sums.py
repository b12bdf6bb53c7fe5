"""Rates at the contact points as sums over bodies, for the interior-point method."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np


class RateSum(ABC):
    """Sum of rates that increase with the pressure at each point."""

    @abstractmethod
    def terms(self, pressure: np.ndarray) -> np.ndarray:
        """Summands, shape (m, n)."""

    @abstractmethod
    def slopes(self, pressure: np.ndarray) -> np.ndarray:
        """Derivatives of the summands at positive pressures, shape (m, n)."""

    @abstractmethod
    def scaled(self, pressure: np.ndarray, value: float) -> RateSum:
        """Sum scaled by a pressure at each point and by a value."""

    def at(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Value and derivative at positive pressures, shape (n,) each."""
        return self.terms(pressure).sum(axis=0), self.slopes(pressure).sum(axis=0)


@dataclass(frozen=True)
class PowerSum(RateSum):
    """Pointwise sum of powers ``Σ_i g_i p^e_i``.

    Attributes
    ----------
    factors : ndarray, shape (m, n)
    exponents : ndarray, shape (m,)
    """

    factors: np.ndarray
    exponents: np.ndarray

    def terms(self, pressure: np.ndarray) -> np.ndarray:
        return self.factors * pressure ** self.exponents[:, None]

    def slopes(self, pressure: np.ndarray) -> np.ndarray:
        return self.exponents[:, None] * self.terms(pressure) / pressure

    def scaled(self, pressure: np.ndarray, value: float) -> PowerSum:
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
