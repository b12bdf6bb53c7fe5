"""Tabulated factors of a law, by temperature, pressure and speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..interfaces import Law, LocalState
from .table1d import Table1D


@dataclass(frozen=True)
class Multipliers:
    """Law that is a product of tabulated factors.

    Attributes
    ----------
    temperature, pressure, speed : Table1D or None
        Table of each factor; None for a factor of 1.
    """

    temperature: Table1D | None = None
    pressure: Table1D | None = None
    speed: Table1D | None = None

    @property
    def tables(self) -> dict[str, Table1D]:
        """Tables by the name of their variable."""
        tables = {"T": self.temperature, "p": self.pressure, "v": self.speed}
        return {name: table for name, table in tables.items() if table is not None}

    @property
    def variables(self) -> frozenset[str]:
        """Variables with a table, named as in `Law`."""
        return frozenset(self.tables)

    def value(self, at: LocalState) -> np.ndarray:
        """Product of the factors at points (n,)."""
        product = np.ones(np.broadcast_shapes(np.shape(at.p), np.shape(at.v)))
        for name, table in self.tables.items():
            product = product * table.value(getattr(at, name))
        return product

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative of the product with respect to the pressure [1/Pa]."""
        others = Multipliers(self.temperature, None, self.speed).value(at)
        return others * (0.0 if self.pressure is None else self.pressure.slope(at.p))


@dataclass(frozen=True)
class Multiplied:
    """Coefficient of the interface times tabulated factors."""

    law: Law
    factors: Multipliers

    @property
    def variables(self) -> frozenset[str]:
        """Variables of the law and of the factors."""
        return self.law.variables | self.factors.variables

    def value(self, at: LocalState) -> np.ndarray:
        """Coefficient at points (n,)."""
        return self.law.value(at) * self.factors.value(at)

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure."""
        first = self.law.slope(at) * self.factors.value(at)
        return first + self.law.value(at) * self.factors.slope(at)
