"""Functions with known Sobol indices, the usual tests of sensitivity analysis.

Ishigami and Homma, Proc. ISUMA '90, p. 398; g-function: Sobol, Math. Comput. Simul. 61 (2003) 265;
variances: Saltelli et al., Global Sensitivity Analysis, 2008, sections 4.6 and 4.9.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np


@dataclass(frozen=True)
class Ishigami:
    """Function ``sin x1 + a sin² x2 + b x3⁴ sin x1`` of inputs uniform in (-π, π)."""

    a: float = 7.0
    b: float = 0.1

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """Values at points of shape (…, 3)."""
        x1, x2, x3 = np.moveaxis(x, -1, 0)
        return np.sin(x1) * (1 + self.b * x3**4) + self.a * np.sin(x2) ** 2

    @property
    def variance(self) -> float:
        """Variance of the value."""
        return sum(self._alone) + self._interaction

    @property
    def first(self) -> np.ndarray:
        """First-order indices, shape (3,)."""
        return np.array(self._alone) / self.variance

    @property
    def total(self) -> np.ndarray:
        """Total indices, shape (3,)."""
        return self.first + np.array([1.0, 0.0, 1.0]) * self._interaction / self.variance

    @property
    def _alone(self) -> tuple[float, float, float]:
        return (1 + self.b * pi**4 / 5) ** 2 / 2, self.a**2 / 8, 0.0

    @property
    def _interaction(self) -> float:
        """Variance by the interaction of x1 and x3."""
        return self.b**2 * pi**8 * 8 / 225


@dataclass(frozen=True)
class SobolProduct:
    """Function ``Π (|4 x_i - 2| + a_i)/(1 + a_i)`` of inputs uniform in (0, 1): the g-function."""

    a: tuple[float, ...] = (0.0, 0.5, 3.0, 9.0, 99.0)

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """Values at points of shape (…, d)."""
        a = np.array(self.a)
        return np.prod((np.abs(4 * x - 2) + a) / (1 + a), axis=-1)

    @property
    def _shares(self) -> np.ndarray:
        """Variances of the factors."""
        return 1 / (3 * (1 + np.array(self.a)) ** 2)

    @property
    def variance(self) -> float:
        """Variance of the value."""
        return float(np.prod(1 + self._shares) - 1)

    @property
    def first(self) -> np.ndarray:
        """First-order indices, shape (d,)."""
        return self._shares / self.variance

    @property
    def total(self) -> np.ndarray:
        """Total indices, shape (d,)."""
        others = np.prod(1 + self._shares) / (1 + self._shares)
        return self._shares * others / self.variance


@dataclass(frozen=True)
class UniformProduct:
    """Product of independent inputs, each uniform between two positive ends.

    Attributes
    ----------
    ends : tuple of (float, float)
    """

    ends: tuple[tuple[float, float], ...]

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """Values at points of shape (…, d)."""
        return np.prod(x, axis=-1)

    @property
    def _shares(self) -> np.ndarray:
        """Variances of the inputs, relative to the squares of their means."""
        low, high = np.array(self.ends).T
        return (high - low) ** 2 / 3 / (high + low) ** 2

    @property
    def first(self) -> np.ndarray:
        """First-order indices, shape (d,)."""
        return self._shares / (np.prod(1 + self._shares) - 1)

    @property
    def total(self) -> np.ndarray:
        """Total indices, shape (d,)."""
        return self.first * np.prod(1 + self._shares) / (1 + self._shares)
