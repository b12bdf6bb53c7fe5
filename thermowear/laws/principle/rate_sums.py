"""Rates at the contact points as sums over bodies, for the interior-point method."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...errors import ComputationError
from ..interfaces import Law, LocalState

_MULTIPLES = np.array([0.03, 0.1, 0.3, 0.6, 1.0, 1.5, 3.0, 10.0])
"""Multiples of the steady pressure between which a rate must not decrease."""
_ROUNDING = 1e-9


class RateSum(ABC):
    """Sum of rates that increase with the pressure at each point."""

    @abstractmethod
    def terms(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Summands and their derivatives at positive pressures, shape (m, n) each."""

    @abstractmethod
    def scaled(self, pressure: np.ndarray, value: float) -> RateSum:
        """Sum scaled by a pressure at each point and by a value."""

    def at(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Value and derivative at positive pressures, shape (n,) each."""
        terms, slopes = self.terms(pressure)
        return terms.sum(axis=0), slopes.sum(axis=0)


@dataclass(frozen=True)
class PowerSum(RateSum):
    """Pointwise sum of powers ``Σ_i g_i p^e_i``.

    Attributes
    ----------
    factors : ndarray, shape (m, n)
    exponents : ndarray, shape (m,) or (m, n)
    """

    factors: np.ndarray
    exponents: np.ndarray

    def terms(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        exponents = np.atleast_2d(self.exponents.T).T
        terms = self.factors * pressure**exponents
        return terms, exponents * terms / pressure

    def scaled(self, pressure: np.ndarray, value: float) -> PowerSum:
        return PowerSum(self.terms(pressure)[0] / value, self.exponents)


@dataclass(frozen=True)
class BoundLaw:
    """Wear law at the contact points, as a function of the pressure only.

    Attributes
    ----------
    law : Law
    state : LocalState
        State of the points; its pressure is not used.
    """

    law: Law
    state: LocalState

    def rate(self, pressure: np.ndarray) -> np.ndarray:
        """Local wear rate (n,) [m/s]."""
        return self.law.value(self.state._replace(p=pressure))

    def slope(self, pressure: np.ndarray) -> np.ndarray:
        """Derivative with respect to the pressure (n,) [m/(s Pa)]."""
        return self.law.slope(self.state._replace(p=pressure))

    def require_growth(self, pressure: np.ndarray) -> None:
        """Reject a law whose rate decreases with pressure, around given pressures.

        Raises
        ------
        ComputationError
            If the rate decreases with pressure.
        """
        rates = np.array([self.rate(factor * pressure) for factor in _MULTIPLES])
        if np.any(np.diff(rates, axis=0) < -_ROUNDING * rates[:-1]):
            raise ComputationError(
                "no steady state: a wear rate decreases with increasing pressure; the steady "
                "principle requires wear rates that increase with it"
            )


@dataclass(frozen=True)
class LawSum(RateSum):
    """Weighted rates of several laws, in units of a pressure at each point.

    Attributes
    ----------
    laws : sequence of BoundLaw
        Law of each summand.
    weights : ndarray, shape (m, n)
    pressure : ndarray, shape (n,)
        Unit of the pressures [Pa].
    """

    laws: Sequence[BoundLaw]
    weights: np.ndarray
    pressure: np.ndarray

    def terms(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        p, shape = self.pressure * pressure, self.weights.shape
        rates = np.reshape([law.rate(p) for law in self.laws], shape)
        slopes = np.reshape([law.slope(p) for law in self.laws], shape)
        return self.weights * rates, self.weights * self.pressure * slopes

    def scaled(self, pressure: np.ndarray, value: float) -> LawSum:
        return LawSum(self.laws, self.weights / value, self.pressure * pressure)


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
        terms, slopes = self.means.terms(pressure)
        return terms.sum(axis=1), slopes

    def scaled(self, pressure: np.ndarray, value: float) -> Common:
        """Sum scaled by a pressure at each point and by a value."""
        return Common(self.means.scaled(pressure, value), self.reach)
