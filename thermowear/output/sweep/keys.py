"""Swept keys: their columns in SI, and their labels in pictures."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import Any

from ..variants.units import QUANTITY, in_header, in_pictures, in_si, value_at

_LONG = 44  # characters in a line of a legend


@dataclass(frozen=True)
class Swept:
    """Swept key with its value in each variant.

    Attributes
    ----------
    key : str
        Path of the key.
    header : str
        Column name, with the SI unit of a quantity.
    values : tuple of float or str
        Values in SI, or as given by the user.
    """

    key: str
    header: str
    values: tuple[float | str, ...]


@dataclass(frozen=True)
class Axis:
    """Swept key in a picture.

    Attributes
    ----------
    key : str
    label : str
        Key with the unit of the given values.
    numbers : tuple of float or None
        Distinct values; None if they are not numeric.
    words : tuple of str
        Distinct values as text.
    """

    key: str
    label: str
    numbers: tuple[float, ...] | None
    words: tuple[str, ...]


def swept(key: str, written: Sequence[str], tables: Sequence[dict[str, Any]]) -> Swept:
    """Swept key with its column of values.

    Parameters
    ----------
    key : str
    written : sequence of str
        Value given for each variant.
    tables : sequence of dict
        Case of each variant with all default values.
    """
    resolved: list[Any] = [value_at(key, table) for table in tables]
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in resolved):
        return Swept(key, key, tuple(resolved))
    found = [in_si(value) for value in resolved]
    units = {unit for _, unit in filter(None, found)}
    if None in found or not units:
        return Swept(key, key, tuple(text.strip() for text in written))
    unit = units.pop() if len(units) == 1 else "SI"
    return Swept(key, f"{key}_{in_header(unit)}", tuple(pair[0] for pair in found if pair))


def axis(key: str, written: Sequence[str], values: Sequence[float | str], header: str) -> Axis:
    """Label and values of a key in pictures: in the given unit if it is common, else in SI.

    Parameters
    ----------
    key : str
    written : sequence of str
        Distinct values as given by the user.
    values : sequence of float or str
        Distinct values in SI.
    header : str
        Header of the column.
    """
    found = [QUANTITY.fullmatch(text) for text in written]
    words = tuple("\n".join(wrap(re.sub("[{}\"']", "", text).strip(), _LONG)) for text in written)
    units = {match[2] or "" for match in found if match}
    if None not in found and len(units) == 1:
        unit = in_pictures(units.pop())
        numbers = tuple(float(match[1]) for match in found if match)
        return Axis(key, f"{key} [{unit}]" if unit else key, numbers, words)
    if all(isinstance(value, float) for value in values):
        unit = header.removeprefix(key).lstrip("_").replace("_", " ")
        return Axis(key, f"{key} [{unit}]" if unit else key, tuple(map(float, values)), words)
    return Axis(key, key, None, words)
