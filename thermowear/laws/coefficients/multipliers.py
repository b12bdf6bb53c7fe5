"""Tabulated factors of a law, by temperature, pressure and speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..interfaces import InterfaceLaw, Values
from .table1d import Table1D


@dataclass(frozen=True)
class Multipliers:
    """Product of tabulated factors.

    Attributes
    ----------
    temperature, pressure, speed : Table1D or None
        Table of each factor; None for a factor of 1.
    """

    temperature: Table1D | None = None
    pressure: Table1D | None = None
    speed: Table1D | None = None

    @property
    def variables(self) -> frozenset[str]:
        """Variables with a table, named as in `InterfaceLaw`."""
        tables = {"T": self.temperature, "p": self.pressure, "v": self.speed}
        return frozenset(name for name, table in tables.items() if table is not None)

    def value(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Product of the factors at points (n,)."""
        product = np.ones(np.broadcast_shapes(np.shape(pressure), np.shape(speed)))
        tables = (self.temperature, temperature), (self.pressure, pressure), (self.speed, speed)
        for table, at in tables:
            if table is not None:
                product = product * table.value(at)
        return product

    def slope(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Derivative of the product with respect to the pressure [1/Pa]."""
        if self.pressure is None:
            return np.zeros(np.broadcast_shapes(np.shape(pressure), np.shape(speed)))
        others = Multipliers(self.temperature, None, self.speed)
        return others.value(pressure, speed, temperature) * self.pressure.slope(pressure)


@dataclass(frozen=True)
class Multiplied:
    """Coefficient of the interface times tabulated factors.

    Attributes
    ----------
    law : InterfaceLaw
    factors : Multipliers
    """

    law: InterfaceLaw
    factors: Multipliers

    @property
    def variables(self) -> frozenset[str]:
        """Variables of the law and of the factors."""
        return self.law.variables | self.factors.variables

    def value(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Coefficient at points (n,)."""
        at = pressure, speed, temperature
        return self.law.value(*at) * self.factors.value(*at)

    def slope(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Derivative with respect to the pressure."""
        at = pressure, speed, temperature
        first = self.law.slope(*at) * self.factors.value(*at)
        return first + self.law.value(*at) * self.factors.slope(*at)
