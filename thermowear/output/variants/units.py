"""SI values and units of quantities in resolved cases, and their columns in tables."""

from __future__ import annotations

import re
from functools import reduce
from typing import Any

QUANTITY = re.compile(r'\s*"?([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([^"\d\s][^"]*?)?"?\s*')
"""Number and unit of a quantity as written."""
_SI = {"m", "Pa", "N", "s", "rad", "Hz", "W", "K", "kg", "J"}
_SIGNS = {"degC": "°C", "um": "µm", "^2": "²", "^3": "³", "**2": "²", "**3": "³"}


def value_at(key: str, tables: dict[str, Any]) -> Any:
    """Value of a key in nested tables by its path; None if there is none."""
    return reduce(_entry, key.split("."), tables)


def in_si(text: Any) -> tuple[float, str] | None:
    """Number and SI unit of a quantity of a resolved case; None if it is not a quantity."""
    match = QUANTITY.fullmatch(text) if isinstance(text, str) else None
    if match is None or match[2] is None:
        return None
    if set(re.findall(r"[A-Za-z]+", match[2])) <= _SI:
        return float(match[1]), match[2]
    return _converted(text)


def in_header(unit: str) -> str:
    """Unit as part of a column name: ``W/m^2/K`` becomes ``W_per_m2_K``."""
    above, *below = unit.replace("^", "").replace("**", "").replace("*", " ").split("/")
    name = "".join(above.split())
    return f"{name}_per_{'_'.join('_'.join(below).split())}" if below else name


def in_pictures(unit: str) -> str:
    """Unit in labels: ``um`` becomes ``µm``, ``m^2`` becomes ``m²``."""
    for text, sign in _SIGNS.items():
        unit = unit.replace(text, sign)
    return unit


def _entry(table: Any, key: str) -> Any:
    return table.get(key.strip()) if isinstance(table, dict) else None


def _converted(text: str) -> tuple[float, str] | None:
    """Number and SI unit of a wear coefficient, which a resolved case keeps in its given unit."""
    from ...case.values.units import parse

    try:
        value = parse(text, "")
    except ValueError:
        return None
    value = value.to("1/Pa") if value.is_compatible_with("1/Pa") else value.to_base_units()
    return float(value.magnitude), f"{value.units:~C}"
