"""Formatting of SI numbers in engineering units (50 MPa, 44.6 µm, 2199.11 kN), and of tables."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any

from ...results.quantity import multiple, split_key

NOTHING = "–"
_QUANTITY = re.compile(r"([-+]?[.\d]+(?:e[-+]?\d+)?) (\S+)")
_POWERS = str.maketrans({"2": "²", "3": "³", "^": None})


def number(value: float) -> str:
    """Format a number with six digits, integers in groups of three; a dash if not finite."""
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f")
    return f"{value + 0.0:.6g}" if math.isfinite(value) else NOTHING


def quantity(value: Any, si: str) -> str:
    """Format any value of ``summary.json`` in the unit that suits its size.

    Parameters
    ----------
    value : object
        Any value of a JSON file.
    si : str
        SI unit of its numbers; may be empty.
    """
    if isinstance(value, dict):
        return ", ".join(_entry(key, inner, si) for key, inner in value.items()) or NOTHING
    sizes = [abs(size) for size in _numbers(value)]
    unit, scale = multiple(si, max(sizes, default=0.0))
    parts = value if _is_list(value) else [value]
    text = ", ".join(_text(part, si, scale) for part in parts) or NOTHING
    return f"{text} {unit}" if unit and sizes else text


def _entry(key: str, value: Any, si: str) -> str:
    name, own = split_key(key)
    return f"{name}: {quantity(value, own or si)}"


def _text(value: Any, si: str, scale: float) -> str:
    """Format one value times a scale; nested lists, such as intervals, in brackets."""
    if _is_list(value):
        return f"[{', '.join(_text(part, si, scale) for part in value)}]"
    if isinstance(value, dict):
        return quantity(value, si)
    if value is None:
        return NOTHING
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return number(value if scale == 1.0 else value * scale)
    return str(value)


def _numbers(value: Any) -> Iterator[float]:
    """Iterate over the finite numbers in a value and in its lists."""
    if _is_list(value):
        for part in value:
            yield from _numbers(part)
    elif isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        yield value


def _is_list(value: Any) -> bool:
    return isinstance(value, list | tuple)


def table_lines(tables: dict[str, Any], name: str, above: str = "") -> list[tuple[str, str]]:
    """Name and content of each table with entries, such as ``bodies.punch``.

    Parameters
    ----------
    tables : dict
        Nested tables of a file.
    name : str
        Name for the keys outside any table.
    above : str
        Path of the tables within the file.
    """
    plain = {key: value for key, value in tables.items() if not isinstance(value, dict)}
    content = " · ".join(f"{split_key(key)[0]} {_shown(value)}" for key, value in plain.items())
    lines = [(above.rstrip(".") or name, content)] if content else []
    for key, inner in tables.items():
        if isinstance(inner, dict):
            lines += table_lines(inner, name, f"{above}{key}.")
    return lines


def _shown(value: Any) -> str:
    """Format a value of a case file; quantities such as ``"0.02 m"`` in a unit that suits them."""
    if isinstance(value, list):
        return ", ".join(map(_shown, value))
    written = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if written is None:
        return quantity(value, "")
    unit = re.sub(r"\^[23]", lambda power: power[0].translate(_POWERS), written[2])
    return quantity(float(written[1]), unit)
