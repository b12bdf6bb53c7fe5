"""The modified Archard law: ``rate = κ p^b v^a`` (Páczelt and Mróz 2007, with κ = β μ^b)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_FLOOR = 1e-9  # of the largest pressure: where p^b has an infinite slope (b < 1) at p = 0


@dataclass(frozen=True)
class WearLaw:
    """Wear law of one body, friction included.

    Attributes
    ----------
    coefficient : float
        κ in ``(m/s)^(1-a) Pa^(-b)``; for a = b = 1 Archard's k.
    pressure_exponent, velocity_exponent : float
        b and a.
    """

    coefficient: float
    pressure_exponent: float = 1.0
    velocity_exponent: float = 1.0

    @classmethod
    def per_friction_stress(cls, β: float, friction: float, b: float, a: float) -> WearLaw:
        """The law ``β (μ p)^b v^a``."""
        return cls(β * friction**b, b, a)

    def factor(self, speed: np.ndarray) -> np.ndarray:
        """Z = κ v^a at points, so that the rate is Z p^b."""
        return self.coefficient * np.power(speed, self.velocity_exponent)

    def rate(self, pressure: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Depth worn per time [m/s] at pressures [Pa] and speeds [m/s], shape (n,)."""
        return self.factor(speed) * np.power(np.maximum(pressure, 0.0), self.pressure_exponent)

    def slope(self, pressure: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Derivative of the rate by the pressure [m/(s Pa)]; finite at p = 0 also for b < 1."""
        b = self.pressure_exponent
        floor = _FLOOR * max(float(np.max(pressure, initial=0.0)), 1.0)
        return self.factor(speed) * b * np.power(np.maximum(pressure, floor), b - 1.0)
