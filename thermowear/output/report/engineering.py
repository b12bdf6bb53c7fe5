"""Formatting of SI numbers in engineering units: 50 MPa, 44.6 µm, 2199.11 kN."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

NOTHING = "–"

_MULTIPLES: dict[str, tuple[tuple[float, str, float], ...]] = {
    "Pa": ((1e10, "GPa", 1e-9), (0.0, "MPa", 1e-6)),
    "N": ((1e3, "kN", 1e-3), (0.0, "N", 1.0)),
    "N m": ((1e3, "kN m", 1e-3), (0.0, "N m", 1.0)),
    "m": ((1e-3, "mm", 1e3), (0.0, "µm", 1e6)),
    "m²": ((0.0, "mm²", 1e6),),
    "m³": ((0.0, "mm³", 1e9),),
    "m/s": ((1.0, "m/s", 1.0), (1e-3, "mm/s", 1e3), (1e-6, "µm/s", 1e6), (0.0, "nm/s", 1e9)),
    "W": ((1e3, "kW", 1e-3), (0.0, "W", 1.0)),
    "W/m²": ((1e3, "kW/m²", 1e-3), (0.0, "W/m²", 1.0)),
    "J": ((1e3, "kJ", 1e-3), (1.0, "J", 1.0), (1e-3, "mJ", 1e3), (0.0, "µJ", 1e6)),
    "rad": ((1.0, "rad", 1.0), (1e-3, "mrad", 1e3), (0.0, "µrad", 1e6)),
    "rad/s": ((1e-3, "rad/s", 1.0), (0.0, "nrad/s", 1e9)),
}
"""Engineering units by SI unit: smallest size [SI], unit, and scale from the SI unit."""

_IN_KEYS = {
    **{unit: unit for unit in ("Pa", "N", "m", "s", "K", "W", "J", "rad", "Hz", "kg")},
    **{"Nm": "N m", "m2": "m²", "m3": "m³"},
}
"""SI units by their spelling in the keys of results."""


def split_key(key: str) -> tuple[str, str]:
    """Name and SI unit of a key such as ``wear_rate_1_m_per_s``: ``wear rate 1`` and ``m/s``."""
    *words, last = key.split("_")
    unit = _IN_KEYS.get(last, "")
    if unit and len(words) >= 2 and words[-1] == "per" and words[-2] in _IN_KEYS:
        words, unit = words[:-2], f"{_IN_KEYS[words[-2]]}/{unit}"
    if not unit or not words:
        return key.replace("_", " "), ""
    return " ".join(words), unit


def multiple(si: str, size: float) -> tuple[str, float]:
    """Engineering unit for numbers up to a size [SI], and its scale from the SI unit."""
    for least, unit, scale in _MULTIPLES.get(si, ((0.0, si, 1.0),)):
        if abs(size) >= least:
            return unit, scale
    return si, 1.0  # the size is not a number


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
