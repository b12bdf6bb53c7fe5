"""Modified Archard law: ``rate = κ p^b v^a`` (Páczelt and Mróz 2007, with κ = β μ^b)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .interfaces import LocalState, Values

_FLOOR = 1e-9  # relative to the largest pressure: avoids the infinite slope of p^b (b < 1) at p = 0


def floored(pressure: Values) -> np.ndarray:
    """Pressures bounded from below, so that a law has a finite slope at zero pressure [Pa]."""
    return np.maximum(pressure, _FLOOR * max(float(np.max(pressure, initial=0.0)), 1.0))


@dataclass(frozen=True)
class PowerWear:
    """Power law of wear of one body, friction included.

    Attributes
    ----------
    coefficient : float or ndarray, shape (n,)
        κ in ``(m/s)^(1-a) Pa^(-b)``; for a = b = 1 Archard's k.
    pressure_exponent, velocity_exponent : float or ndarray, shape (n,)
        b and a. Arrays are values at the contact points, see `law_by_point`.
    """

    coefficient: Values
    pressure_exponent: Values = 1.0
    velocity_exponent: Values = 1.0
    variables: ClassVar[frozenset[str]] = frozenset({"p", "v"})

    @classmethod
    def per_friction_stress(cls, β: float, friction: float, b: float, a: float) -> PowerWear:
        """Build the law ``β (μ p)^b v^a`` in the friction stress."""
        return cls(β * friction**b, b, a)

    def factor(self, speed: Values) -> np.ndarray:
        """Factor Z = κ v^a at points, so that the rate is Z p^b."""
        return self.coefficient * np.power(speed, self.velocity_exponent)

    def value(self, at: LocalState) -> np.ndarray:
        """Depth worn per time at points (n,) [m/s]."""
        return self.factor(at.v) * np.power(np.maximum(at.p, 0.0), self.pressure_exponent)

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure [m/(s Pa)]; finite at p = 0 for b < 1, too."""
        b = self.pressure_exponent
        return self.factor(at.v) * b * np.power(floored(at.p), b - 1.0)
