"""Expressions of laws, with units by pint."""

from __future__ import annotations

import math
from functools import lru_cache

from ...laws.expressions import Dimension, Expression, parse_expression
from ...laws.interfaces import UNITS
from .units import registry, unit_of

_ROUNDING = 1e-9


def expression(text: str, unit: str, variables: tuple[str, ...]) -> Expression:
    """Parse the expression of a law.

    Parameters
    ----------
    text : str
        Value of the key in the case file.
    unit : str
        Unit of the value of the expression.
    variables : tuple of str
        Variables that may occur, from `UNITS`.

    Raises
    ------
    ValueError
        One-line message with the position of the fault.
    """
    known = {name: _dimension(UNITS[name]) for name in variables}
    return parse_expression(text, known, unit, in_si)


@lru_cache(maxsize=1000)
def in_si(text: str) -> tuple[float, Dimension]:
    """Factor to SI and dimension of a unit.

    Raises
    ------
    ValueError
        If it is invalid, or not proportional to the SI unit (temperature scales, decibels).
    """
    units = registry()
    try:
        unit = unit_of(text)
        one, two = (units.Quantity(number, unit).to_base_units() for number in (1.0, 2.0))
    except Exception as error:  # pint raises a dozen kinds, tokenizer errors among them
        raise ValueError(f"{text!r} is not a unit") from error
    if not 0.0 < one.magnitude < math.inf:
        raise ValueError(f"the unit {text!r} is out of range in SI")
    if abs(two.magnitude / one.magnitude - 2.0) > _ROUNDING:
        raise ValueError(f"{text!r} is a scale with an offset; write temperatures in K (293.15 K)")
    powers = {
        units.get_symbol(name): power
        for name, power in one.unit_items()
        if not units.Quantity(1.0, name).dimensionless  # radians and counts
    }
    return float(one.magnitude), Dimension.of(powers)


def _dimension(unit: str) -> Dimension:
    return in_si(unit)[1] if unit else Dimension()
