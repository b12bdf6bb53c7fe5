"""Quantities with units, written by the user and turned to SI at the border.

Every dimensional key of a case file is a string such as ``"50 MPa"``. Inside the
program there are only SI numbers.
"""

from __future__ import annotations

import math
import operator
import re
from functools import lru_cache
from typing import Annotated, Any

from pydantic import BeforeValidator, PlainSerializer

_NUMBER = re.compile(r"\s*([-+]?(?:nan\b|inf\b|(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?))", re.IGNORECASE)
_BOUNDS = {
    "gt": (operator.gt, "greater than"),
    "ge": (operator.ge, "at least"),
    "ne": (operator.ne, "other than"),
}
_ANGLES = ("radian", "turn", "revolution", "degree")


@lru_cache(maxsize=1)
def registry():
    """The one unit registry (made at first use: it is slow to build)."""
    import pint

    units = pint.UnitRegistry(autoconvert_offset_to_baseunit=True)
    pint.set_application_registry(units)
    return units


def parse(text: Any, example: str):
    """Read a quantity written as text.

    Parameters
    ----------
    text : object
        What the case file holds at the key.
    example : str
        A well-formed value, for the message.

    Returns
    -------
    pint.Quantity

    Raises
    ------
    ValueError
        If it is not a string, has no unit, or is not understood.
    """
    import pint

    if isinstance(text, pint.Quantity):
        return text
    if not isinstance(text, str):
        raise ValueError(f'found {text!r}; needs a quantity with its unit, such as "{example}"')
    try:
        value = _read(text)
    except Exception as error:  # pint raises a dozen kinds, tokenizer errors among them
        raise ValueError(f'cannot read "{text}"; write it like "{example}"') from error
    if value.unitless:
        raise ValueError(f'found "{text}" without a unit; write it like "{example}"')
    if not math.isfinite(value.magnitude):
        raise ValueError(f'found "{text}"; the number must be finite')
    return value


def _read(text: str):
    """Number and unit apart: only so does ``W/(m^2 degC)`` mean a difference of temperatures."""
    number = _NUMBER.match(text)
    if number is None:
        raise ValueError("no number")
    unit = text[number.end() :].strip()
    if unit.startswith("/"):
        unit = f"1{unit}"
    return registry().Quantity(float(number[1]), registry().parse_units(unit, as_delta=True))


def _to_si(unit: str, example: str, bounds: dict[str, float], text: Any) -> float:
    value = parse(text, example)
    if not value.is_compatible_with(unit):
        raise ValueError(
            f'"{text}" has the dimension {value.dimensionality}; needs one of {unit}, '
            f'such as "{example}"'
        )
    if unit == "rad/s" and "hertz" in str(value.units):
        raise ValueError(f'found "{text}", which counts turns; write turn/s, or rad/s')
    if unit == "Hz" and any(angle in str(value.units) for angle in _ANGLES):
        raise ValueError(f'found "{text}", which measures angles; write Hz, or 1/s')
    number = float(value.to(unit).magnitude)
    if not math.isfinite(number):
        raise ValueError(f'found "{text}"; the number must be finite in {unit} too')
    for word, bound in bounds.items():
        holds, phrase = _BOUNDS[word]
        if not holds(number, bound):
            raise ValueError(f'found "{text}"; must be {phrase} {bound:g} {unit}')
    return number


def quantity(unit: str, example: str, **bounds: float):
    """Type of a key that holds a quantity: a float in SI inside, text with a unit outside.

    Parameters
    ----------
    unit : str
        The SI unit the number is kept in.
    example : str
        A well-formed value, shown in messages.
    **bounds
        ``gt``, ``ge``, ``ne`` in SI.
    """
    return Annotated[
        float,
        BeforeValidator(lambda text: _to_si(unit, example, bounds, text)),
        PlainSerializer(lambda value: f"{value!r} {unit}", return_type=str),
    ]


Length = quantity("m", "20 mm", gt=0)
Distance = quantity("m", "0.05 mm", ge=0)
Radius = quantity("m", "0.5 mm", ge=0)
Angle = quantity("rad", "30 deg")
Coordinate = quantity("m", "-5 mm")
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
