"""Tables of factors by temperature, pressure or speed."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Generic, TypeVar

from pydantic import Field, model_validator

from ...laws.coefficients import Multipliers, Table1D
from ..values import units
from ..values.section import KeyFault, Number, Section

Positive = Annotated[Number, Field(gt=0.0)]
NotNegative = Annotated[Number, Field(ge=0.0)]
At = TypeVar("At", bound=float)
Factor = TypeVar("Factor", bound=float)


def must_increase(key: str, values: tuple[float, ...]) -> None:
    """Reject a list that is empty or not strictly increasing."""
    if not values:
        raise KeyFault(key, "is empty; needs at least one value")
    if any(b <= a for a, b in pairwise(values)):
        raise KeyFault(key, "must increase")


def must_match(key: str, values: tuple[float, ...], places: tuple[float, ...], what: str) -> None:
    """Reject a list whose length differs from that of another list."""
    if len(values) != len(places):
        raise KeyFault(key, f"has {len(values)} values for {len(places)} {what}")


class MultiplierTable(Section, Generic[At, Factor]):
    """Piecewise linear factor of one variable, constant beyond the ends.

    Attributes
    ----------
    at : tuple of float
        Increasing, in SI.
    factor : tuple of float
    """

    at: tuple[At, ...]
    factor: tuple[Factor, ...]

    @model_validator(mode="after")
    def _fits(self):
        must_increase("at", self.at)
        must_match("factor", self.factor, self.at, "places")
        return self

    @property
    def table(self) -> Table1D:
        """Factor as a piecewise linear function."""
        return Table1D(self.at, self.factor)


TemperatureTable = MultiplierTable[units.Temperature, Positive]
PressureTable = MultiplierTable[units.LeastPressure, Positive]
SpeedTable = MultiplierTable[units.Speed, Positive]
ExpansionTable = MultiplierTable[units.Temperature, NotNegative]
"""Factor of the secant coefficient of expansion, which may be 0."""


class MultiplierTables(Section):
    """Product of tabulated factors."""

    temperature: TemperatureTable | None = None
    pressure: PressureTable | None = None
    speed: SpeedTable | None = None

    @property
    def depends_on(self) -> tuple[str, ...]:
        """Variables with a table: temperature, pressure, speed."""
        return tuple(name for name, table in self if table is not None)

    @property
    def multipliers(self) -> Multipliers:
        """Factors as a law."""
        return Multipliers(**{name: getattr(self, name).table for name in self.depends_on})
