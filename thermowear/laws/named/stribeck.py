"""Stribeck friction, decreasing with speed from a static to a kinetic coefficient."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..interfaces import LocalState, parameter, registered


@registered("friction", "stribeck")
@dataclass(frozen=True)
class StribeckFriction:
    """Coefficient ``kinetic + (static - kinetic) exp(-v/speed)``.

    The exponential Stribeck curve (Bo and Pavelescu, Wear 82 (1982) 277) of exponent 1.

    Attributes
    ----------
    static, kinetic : float
        Coefficients at rest and at high speed.
    speed : float
        Speed at which the difference has fallen to 1/e [m/s].
    """

    static: float = parameter("", "0.35", gt=0)
    kinetic: float = parameter("", "0.1", gt=0)
    speed: float = parameter("m/s", "0.5 m/s", gt=0)
    variables: ClassVar[frozenset[str]] = frozenset("v")

    def value(self, at: LocalState) -> np.ndarray:
        """Coefficient at points (n,)."""
        fallen = (self.static - self.kinetic) * np.exp(-np.asarray(at.v) / self.speed)
        return np.full(np.shape(at.p), self.kinetic) + fallen

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure: 0."""
        return np.zeros(np.shape(at.p))
