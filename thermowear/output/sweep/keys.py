"""Swept keys: their columns in SI, and how pictures name them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from textwrap import wrap
from typing import Any

_QUANTITY = re.compile(r'\s*"?([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([^"\d\s][^"]*?)?"?\s*')
_SI = {"m", "Pa", "N", "s", "rad", "Hz", "W", "K", "kg", "J"}
_LONG = 44  # characters in a line of a legend
_SIGNS = {"degC": "°C", "um": "µm", "^2": "²", "^3": "³", "**2": "²", "**3": "³"}


@dataclass(frozen=True)
class Swept:
    """A key that a sweep goes over, with its value in each variant.

    Attributes
    ----------
    key : str
        Its path.
    header : str
        Column name, with the SI unit of a quantity.
    values : tuple of float or str
        In SI, or as it was written.
    """

    key: str
    header: str
    values: tuple[float | str, ...]


@dataclass(frozen=True)
class Axis:
    """A swept key in a picture.

    Attributes
    ----------
    key : str
    label : str
        With the unit in which the values were written.
    numbers : tuple of float or None
        The different values; None where they are words.
    words : tuple of str
    """

    key: str
    label: str
    numbers: tuple[float, ...] | None
    words: tuple[str, ...]


def swept(key: str, written: Sequence[str], tables: Sequence[dict[str, Any]]) -> Swept:
    """Column of a key.

    Parameters
    ----------
    key : str
    written : sequence of str
        As it was written for each variant.
    tables : sequence of dict
        The case of each variant with its defaults written out.
    """
    resolved = [_found(table, key) for table in tables]
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in resolved):
        return Swept(key, key, tuple(resolved))
    found = [_in_si(value) for value in resolved]
    units = {unit for _, unit in filter(None, found)}
    if None in found or not units:
        return Swept(key, key, tuple(text.strip() for text in written))
    unit = units.pop() if len(units) == 1 else "SI"
    return Swept(key, f"{key}_{_in_name(unit)}", tuple(pair[0] for pair in found if pair))


def axis(key: str, written: Sequence[str], values: Sequence[float | str], header: str) -> Axis:
    """How pictures show a key: in its unit if all values have the same, else in SI.

    Parameters
    ----------
    key : str
    written : sequence of str
        The different values, as they were written.
    values : sequence of float or str
        The same in SI.
    header : str
        Of the column.
    """
    found = [_QUANTITY.fullmatch(text) for text in written]
    words = tuple("\n".join(wrap(re.sub("[{}\"']", "", text).strip(), _LONG)) for text in written)
    units = {match[2] or "" for match in found if match}
    if None not in found and len(units) == 1:
        unit = reduce(lambda text, sign: text.replace(*sign), _SIGNS.items(), units.pop())
        numbers = tuple(float(match[1]) for match in found if match)
        return Axis(key, f"{key} [{unit}]" if unit else key, numbers, words)
    if all(isinstance(value, float) for value in values):
        unit = header.removeprefix(key).lstrip("_").replace("_", " ")
        return Axis(key, f"{key} [{unit}]" if unit else key, tuple(map(float, values)), words)
    return Axis(key, key, None, words)


def _found(table: dict[str, Any], key: str) -> Any:
    """The value at a path; None where there is none."""
    found: Any = table
    for part in key.split("."):
        found = found.get(part.strip()) if isinstance(found, dict) else None
    return found


def _in_si(text: Any) -> tuple[float, str] | None:
    """Number and SI unit of a quantity of a resolved case; None of anything else."""
    match = _QUANTITY.fullmatch(text) if isinstance(text, str) else None
    if match is None or match[2] is None:
        return None
    if set(re.findall(r"[A-Za-z]+", match[2])) <= _SI:
        return float(match[1]), match[2]
    return _converted(text)


def _converted(text: str) -> tuple[float, str] | None:
    """Of wear coefficients, which a resolved case has in the unit they were given in."""
    from ...case.values.units import parse

    try:
        value = parse(text, "")
    except ValueError:
        return None
    value = value.to("1/Pa") if value.is_compatible_with("1/Pa") else value.to_base_units()
    return float(value.magnitude), f"{value.units:~C}"


def _in_name(unit: str) -> str:
    """A unit as part of a column name: ``W/m^2/K`` is ``W_per_m2_K``."""
    above, *below = unit.replace("^", "").replace("**", "").replace("*", " ").split("/")
    name = "".join(above.split())
    return f"{name}_per_{'_'.join('_'.join(below).split())}" if below else name
