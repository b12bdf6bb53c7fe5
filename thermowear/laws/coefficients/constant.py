"""Constant coefficient of the interface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..interfaces import LocalState


@dataclass(frozen=True)
class Constant:
    """Constant coefficient of friction [-], or conductance [W/(m² K)]."""

    number: float
    variables: ClassVar[frozenset[str]] = frozenset()

    def value(self, at: LocalState) -> np.ndarray:
        """Coefficient at points (n,)."""
        return np.full(np.shape(at.p), self.number)

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure: 0."""
        return np.zeros(np.shape(at.p))
