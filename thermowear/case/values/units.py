"""Quantities with units: text in a case file, converted to SI on reading.

Every dimensional key of a case file is a string such as ``"50 MPa"``. The program works
with SI numbers only.
"""

from __future__ import annotations

import math
import operator
import re
from functools import lru_cache
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, PlainSerializer

from ...errors import CaseError, quoted
from ...laws.expressions import Dimension, Expression, parse_expression
from ...laws.formulas import PLACE
from ...laws.interfaces import UNITS
from .json_schema import WrittenAs, quantity_text
from .unit_names import similar_units, unknown_unit, without_offset

_LONGEST = 200
"""Largest number of characters of a quantity."""
_EXTREME = 1e100
"""Largest magnitude in SI: products of three such numbers remain finite."""
_NUMBER = re.compile(r"\s*([-+]?(?:nan\b|inf\b|(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?))", re.IGNORECASE)
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-")
_SUPERSCRIPT = re.compile(rf"[{''.join(map(chr, _SUPERSCRIPTS))}]+")
_EXPONENT = r"[-+]?(?:\d{1,3}(?:\.\d*)?|\.\d+)"
_POWER = re.compile(
    rf"\s*(?:\^|\*\*)\s*(?:{_EXPONENT}|\(\s*{_EXPONENT}(?:\s*/\s*{_EXPONENT})?\s*\))"
    r"(?![\d.]|e[-+]?\d|\s*(?:\^|\*\*))",
    re.IGNORECASE,
)
_WORD = re.compile(r"[^\W\d]\w*")
_ONE = re.compile(r"(?<![\w.])1(?![\w.])")
_NUMERIC = re.compile(r"[\^\d]|\*\*")
_BOUNDS = {
    "gt": (operator.gt, "greater than"),
    "ge": (operator.ge, "at least"),
    "le": (operator.le, "at most"),
    "ne": (operator.ne, "other than"),
}
_OFFSET = 1e-9
"""Largest relative offset of a unit that is proportional to the SI unit."""
_ANGLES = ("radian", "turn", "revolution", "degree")


@lru_cache(maxsize=1)
def registry():
    """The unit registry (created at first use: construction is slow)."""
    import pint

    units = pint.UnitRegistry(autoconvert_offset_to_baseunit=True)
    pint.set_application_registry(units)
    return units


def parse(text: Any, example: str):
    """Read a quantity given as text.

    Parameters
    ----------
    text : object
        Value of the key in the case file.
    example : str
        Well-formed value, for the message.

    Returns
    -------
    pint.Quantity

    Raises
    ------
    ValueError
        If it is no string, has no unit, or cannot be parsed.
    """
    import pint

    if isinstance(text, pint.Quantity):
        return text
    if not isinstance(text, str):
        raise ValueError(
            f'found {quoted(text)}; needs a quantity with its unit, such as "{example}"'
        )
    if len(text) > _LONGEST:
        raise ValueError(
            f"found {quoted(text)}, {len(text)} characters; a quantity has at most {_LONGEST}"
        )
    try:
        with np.errstate(over="ignore"):  # of decibels; values that are not finite are rejected
            value = _read(text)
            bare = value.unitless
    except Exception as error:  # pint raises a dozen kinds, tokenizer errors among them
        why = unknown_unit(error)
        raise ValueError(f'cannot read "{text}"{why}; write it like "{example}"') from error
    if bare:
        raise ValueError(f'found "{text}" without a unit; write it like "{example}"')
    if not math.isfinite(value.magnitude):
        raise ValueError(f'found "{text}"; the number must be finite')
    return value


def _read(text: str):
    """Number and unit parsed separately, so that ``W/(m^2 degC)`` is per temperature difference."""
    number = _NUMBER.match(text)
    if number is None:
        raise ValueError("no number")
    return registry().Quantity(float(number[1]), unit_of(text[number.end() :].strip()))


@lru_cache(maxsize=1000)
def unit_of(text: str):
    """Unit in engineering notation: ``W/(m² K)``, ``/K``, ``mm^3/(N m)``, ``1/MPa**0.5``."""
    text = _SUPERSCRIPT.sub(lambda found: f"**{found[0].translate(_SUPERSCRIPTS)}", text)
    _check_unit(text)
    return registry().parse_units(f"1{text}" if text.startswith("/") else text, as_delta=True)


def _check_unit(unit: str) -> None:
    """Reject nested powers and numbers other than exponents, which pint evaluates exactly.

    ``m^9^9^9`` would have more digits than fit into memory. Allowed are names, operators, the
    number 1, and one small exponent after each of them.
    """
    names_and_signs = _WORD.sub("u", _POWER.sub(" ", unit))
    if _NUMERIC.search(_ONE.sub("", names_and_signs)):
        raise ValueError("a power of a power, a large exponent, or a number")


def _converted(value, unit: str) -> float | None:
    """Number in a unit; infinite if powers of units overflow, None if dimensions differ."""
    try:
        with np.errstate(over="ignore"):
            return float(value.to(unit).magnitude) if value.is_compatible_with(unit) else None
    except (OverflowError, ZeroDivisionError):
        return math.inf


def _to_si(unit: str, example: str, bounds: dict[str, float], text: Any) -> float:
    value = parse(text, example)
    number = _converted(value, unit)
    if number is None:
        raise ValueError(
            f'"{text}" has the dimension {value.dimensionality}; must be in {unit}, '
            f'such as "{example}"'
        )
    if unit == "rad/s" and "hertz" in str(value.units):
        raise ValueError(f'found "{text}", a frequency; write turn/s or rad/s')
    if unit == "Hz" and any(angle in str(value.units) for angle in _ANGLES):
        raise ValueError(f'found "{text}", an angular velocity; write Hz or 1/s')
    if not math.isfinite(number):
        raise ValueError(f'found "{text}"; the number must be finite in {unit} too')
    if number != 0.0 and not 1 / _EXTREME <= abs(number) <= _EXTREME:
        raise ValueError(
            f'found "{text}"; a number other than 0 must be from {1 / _EXTREME:g} to {_EXTREME:g} '
            f"{unit} in size"
        )
    for word, bound in bounds.items():
        holds, phrase = _BOUNDS[word]
        if not holds(number, bound):
            raise ValueError(f'found "{text}"; must be {phrase} {bound:g} {unit}')
    return number


def quantity(unit: str, example: str, **bounds: float):
    """Type of a key that holds a quantity: SI float inside, text with a unit outside.

    Parameters
    ----------
    unit : str
        SI unit of the stored number.
    example : str
        Well-formed value, shown in messages.
    **bounds
        ``gt``, ``ge``, ``le``, ``ne`` in SI, checked in this order.
    """
    return Annotated[
        float,
        BeforeValidator(lambda text: _to_si(unit, example, bounds, text)),
        PlainSerializer(lambda value: f"{value!r} {unit}", return_type=str),
        WrittenAs(quantity_text(unit, example, **bounds)),
    ]


def in_python(kind: Any, value: Any, name: str) -> float:
    """Read an argument of a Python function.

    Parameters
    ----------
    kind : Annotated
        Type made by `quantity`.
    value : float, str or pint.Quantity
        A number is in SI.
    name : str
        Name of the argument, for the message.

    Raises
    ------
    CaseError
        If it is no such quantity, or out of bounds.
    """
    read, written, _ = kind.__metadata__
    bare = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    try:
        return read.func(written.func(float(value)) if bare else value)
    except ValueError as error:
        raise CaseError(f"{name}: {error}") from None


def expression(text: str, unit: str, variables: tuple[str, ...]) -> Expression:
    """Parse the expression of a law.

    Parameters
    ----------
    text : str
        Value of the key in the case file.
    unit : str
        Unit of the value of the expression.
    variables : tuple of str
        Variables that may occur, from `UNITS` or `PLACE`.

    Raises
    ------
    ValueError
        One-line message with the position of the fault.
    """
    units = UNITS | PLACE
    known = {name: in_si(units[name])[1] if units[name] else Dimension() for name in variables}
    return parse_expression(text, known, unit, in_si)


@lru_cache(maxsize=1000)
def in_si(text: str, number: float = 1.0) -> tuple[float, Dimension]:
    """Factor to SI and dimension of a unit; the number before it is for the message.

    Raises
    ------
    ValueError
        If it is invalid, or not proportional to the SI unit (temperature scales, decibels).
    """
    units = registry()
    try:
        unit = unit_of(text)
        one, two = (units.Quantity(x, unit).to_base_units() for x in (1.0, 2.0))
    except Exception as error:  # pint raises a dozen kinds, tokenizer errors among them
        similar = similar_units(text) if _WORD.fullmatch(text) else ""
        raise ValueError(f"{text!r} is not a unit{similar}") from error
    if not 0.0 < one.magnitude < math.inf:
        raise ValueError(f"the unit {text!r} is out of range in SI")
    if abs(two.magnitude / one.magnitude - 2.0) > _OFFSET:
        without = without_offset(units.Quantity(number, unit))
        raise ValueError(f"{text!r} is a scale with an offset; write {without}")
    powers = {
        units.get_symbol(name): power
        for name, power in one.unit_items()
        if not units.Quantity(1.0, name).dimensionless  # radians and counts
    }
    return float(one.magnitude), Dimension.of(powers)


_SMALLEST, _FARTHEST = 1e-12, 1e7
"""Smallest and largest length of a body [m]: larger ones overflow in sums and products of areas."""

Length = quantity("m", "20 mm", gt=0, ge=_SMALLEST, le=_FARTHEST)
Distance = quantity("m", "0.05 mm", ge=0, le=_FARTHEST)
Radius = quantity("m", "0.5 mm", ge=0, le=_FARTHEST)
Angle = quantity("rad", "30 deg")
Twist = quantity("rad", "1 mrad", ge=-0.1, le=0.1)
Coordinate = quantity("m", "-5 mm", ge=-_FARTHEST, le=_FARTHEST)
Moment = quantity("N m", "200 N m", gt=0)
SignedMoment = quantity("N m", "-5 N m")
Compliance = quantity("m/Pa", "2e-7 mm/MPa", gt=0)
Area = quantity("m^2", "200 mm^2", gt=0)
Pressure = quantity("Pa", "50 MPa", gt=0)
LeastPressure = quantity("Pa", "50 MPa", ge=0)
Foundation = quantity("Pa/m", "1e15 Pa/m", gt=0)
Force = quantity("N", "2.2 MN", gt=0)
LeastForce = quantity("N", "2.2 MN", ge=0)
SignedForce = quantity("N", "36 N")
Displacement = quantity("m", "25 um")
Instant = quantity("s", "1 s", ge=0)
Time = quantity("s", "100 s", gt=0)
AngularVelocity = quantity("rad/s", "10 rad/s", ne=0)
Velocity = quantity("m/s", "50 mm/s", ne=0)
Speed = quantity("m/s", "50 mm/s", ge=0)
Frequency = quantity("Hz", "1 Hz", gt=0)
Conductivity = quantity("W/m/K", "50 W/(m K)", gt=0)
Expansion = quantity("1/K", "1.2e-5 1/K", ge=0)
Density = quantity("kg/m^3", "7800 kg/m^3", gt=0)
SpecificHeat = quantity("J/kg/K", "460 J/(kg K)", gt=0)
HeatTransfer = quantity("W/m^2/K", "2000 W/(m^2 K)", gt=0)
LeastHeatTransfer = quantity("W/m^2/K", "2000 W/(m^2 K)", ge=0)
PerLength = quantity("1/m", "2e4 1/m", gt=0)
HeatFlux = quantity("W/m^2", "1e4 W/m^2", ne=0)
Power = quantity("W", "200 W", ne=0)
Temperature = quantity("K", "20 degC", ge=0)
