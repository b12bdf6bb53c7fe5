"""Formatting of SI numbers in engineering units: 50 MPa, 44.6 µm, 2199.11 kN."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from ...results.units import multiple, split_key

NOTHING = "–"


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
