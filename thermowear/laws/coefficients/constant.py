"""Constant coefficient of the interface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..interfaces import Values


@dataclass(frozen=True)
class Constant:
    """Constant coefficient of friction, or conductance.

    Attributes
    ----------
    number : float
        Value [-] or [W/(m² K)].
    """

    number: float
    variables: ClassVar[frozenset[str]] = frozenset()

    def value(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Coefficient at points (n,)."""
        return np.full(np.shape(pressure), self.number)

    def slope(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Derivative with respect to the pressure: 0."""
        return np.zeros(np.shape(pressure))
