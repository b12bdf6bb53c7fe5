"""Pressure-dependent contact conductance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..interfaces import Values
from .table1d import Table1D


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

    def value(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Conductance at points (n,) [W/(m² K)]."""
        return self.coefficient * self.conductivity * np.asarray(pressure) / self.hardness

    def slope(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Derivative with respect to the pressure [W/(m² K Pa)]."""
        slope = self.coefficient * self.conductivity / self.hardness
        return np.broadcast_to(slope, np.shape(pressure))


@dataclass(frozen=True)
class TabulatedConductance:
    """Conductance tabulated over the pressure.

    Attributes
    ----------
    table : Table1D
        Conductance [W/(m² K)] by pressure [Pa].
    """

    table: Table1D
    variables: ClassVar[frozenset[str]] = frozenset("p")

    def value(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Conductance at points (n,) [W/(m² K)]."""
        return self.table.value(pressure)

    def slope(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Derivative with respect to the pressure [W/(m² K Pa)]."""
        return self.table.slope(pressure)
