"""Numbers with or without a unit, kept in the unit that they are written in."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BeforeValidator, PlainSerializer

from ...errors import quoted
from ..values.json_schema import WrittenAs
from ..values.units import parse, registry, unit_of

_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)
_PERCENT = re.compile(r"\s*(\d+\.?\d*|\.\d+)\s*%\s*")


@dataclass(frozen=True)
class Scalar:
    """Number in a unit.

    Attributes
    ----------
    number : float
    unit : str
        Unit as written; empty for a plain number.
    """

    number: float
    unit: str = ""

    def written(self) -> str | float:
        """Value as in a case file."""
        return f"{self.number!r} {self.unit}" if self.unit else self.number

    def override(self, key: str) -> str:
        """Change ``KEY=VALUE`` of a case."""
        return f'{key}="{self.written()}"' if self.unit else f"{key}={self.number!r}"

    def in_unit_of(self, other: Scalar) -> float:
        """Number in the unit of another one.

        Raises
        ------
        ValueError
            If their dimensions differ.
        """
        if bool(self.unit) != bool(other.unit):
            wrong, right = self.written(), other.unit or "a plain number"
            raise ValueError(f"found {quoted(wrong)}; must be in {right}")
        if self.unit == other.unit:
            return self.number
        value = registry().Quantity(self.number, unit_of(self.unit))
        if not value.is_compatible_with(unit_of(other.unit)):
            raise ValueError(f"found {quoted(self.written())}; must be in {other.unit}")
        return float(value.to(unit_of(other.unit)).magnitude)

    def difference_in_unit_of(self, other: Scalar) -> float:
        """Number of a difference, such as a standard deviation, in the unit of another one."""
        return self.in_unit_of(other) - Scalar(0.0, self.unit).in_unit_of(other)


def _scalar(value: Any) -> Scalar:
    if isinstance(value, Scalar):
        return value
    if isinstance(value, int | float) and not isinstance(value, bool):
        return Scalar(float(value))
    parse(value, "2 MPa")  # reports what is wrong
    number = _NUMBER.match(value)
    assert number is not None
    return Scalar(float(number[0]), value[number.end() :].strip())


ScalarKey = Annotated[
    Scalar,
    BeforeValidator(_scalar),
    PlainSerializer(lambda scalar: scalar.written()),
    WrittenAs({"type": ["number", "string"], "examples": ["2 MPa", 0.3]}),
]
"""Type of a key that holds a quantity of any unit, or a plain number."""


@dataclass(frozen=True)
class Spread:
    """Standard deviation, absolute or relative.

    Attributes
    ----------
    absolute : Scalar or None
    relative : float or None
    """

    absolute: Scalar | None = None
    relative: float | None = None

    def written(self) -> str | float:
        """Value as in a case file."""
        if self.absolute is not None:
            return self.absolute.written()
        assert self.relative is not None
        return f"{100.0 * self.relative:.12g} %"

    def of(self, value: Scalar) -> float:
        """Absolute deviation of a value, in its unit."""
        if self.absolute is not None:
            return self.absolute.difference_in_unit_of(value)
        assert self.relative is not None
        return self.relative * abs(value.number)


def _spread(value: Any) -> Spread:
    if isinstance(value, Spread):
        return value
    percent = _PERCENT.fullmatch(value) if isinstance(value, str) else None
    spread = Spread(relative=float(percent[1]) / 100) if percent else Spread(_scalar(value))
    size = spread.absolute.number if spread.absolute is not None else spread.relative
    if not (size or 0.0) > 0.0:
        raise ValueError(f"found {quoted(value)}; must be greater than 0")
    return spread


SpreadKey = Annotated[
    Spread,
    BeforeValidator(_spread),
    PlainSerializer(lambda spread: spread.written()),
    WrittenAs({"type": ["number", "string"], "examples": ["5 %", "0.1 MPa", 0.02]}),
]
"""Type of a key that holds a standard deviation: a quantity, a number, or a percentage."""
