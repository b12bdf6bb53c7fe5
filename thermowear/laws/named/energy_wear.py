"""Wear proportional to the friction power above a threshold."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..interfaces import LocalState, parameter, registered


@registered("wear", "energy")
@dataclass(frozen=True)
class EnergyWear:
    """Wear rate ``coefficient * max(mu p v - threshold, 0)``.

    The energy law of fretting wear (Fouvry, Kapsa and Vincent, Wear 200 (1996) 186) with a
    threshold.

    Attributes
    ----------
    coefficient : float
        Wear volume per dissipated energy [m³/J].
    threshold : float
        Friction power per area below which there is no wear [W/m²].
    """

    coefficient: float = parameter("m^3/J", "2e-13 m^3/J", gt=0)
    threshold: float = parameter("W/m^2", "1e4 W/m^2", default=0.0, ge=0)
    variables: ClassVar[frozenset[str]] = frozenset({"p", "v", "mu"})

    def value(self, at: LocalState) -> np.ndarray:
        """Depth worn per time at points (n,) [m/s]."""
        power = at.mu * np.maximum(at.p, 0.0) * at.v
        return self.coefficient * np.maximum(power - self.threshold, 0.0)

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure [m/(s Pa)]; right-hand at the threshold."""
        wears = at.mu * at.p * at.v >= self.threshold
        return np.where(wears, self.coefficient * at.mu * at.v, 0.0)
