"""Pressure-dependent contact conductance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..interfaces import LocalState


def harmonic_mean(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Harmonic mean ``2 a b / (a + b)``, for two resistances in series."""
    return 2 * a * b / (a + b)


@dataclass(frozen=True)
class PressureConductance:
    """Conductance proportional to the pressure: ``h = coefficient k p / H``.

    k and H are the harmonic means ``2 k1 k2 / (k1 + k2)`` of both bodies' conductivities and
    hardnesses. The model of MOOSE (``GapFluxModelPressureDependentConduction``) and of 4C.

    Attributes
    ----------
    coefficient : float
        Coefficient [1/m].
    conductivity : ndarray, shape (n,)
        Mean conductivity k at the points [W/(m K)].
    hardness : ndarray, shape (n,)
        Mean hardness H at the points [Pa].
    """

    coefficient: float
    conductivity: np.ndarray
    hardness: np.ndarray
    variables: ClassVar[frozenset[str]] = frozenset("p")

    def value(self, at: LocalState) -> np.ndarray:
        """Conductance at points (n,) [W/(m² K)]."""
        return self.coefficient * self.conductivity * np.asarray(at.p) / self.hardness

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure [W/(m² K Pa)]."""
        slope = self.coefficient * self.conductivity / self.hardness
        return np.broadcast_to(slope, np.shape(at.p))
