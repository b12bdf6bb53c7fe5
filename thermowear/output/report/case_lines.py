"""Compact listing of ``case.resolved.toml`` and ``run.json``, one line per table."""

from __future__ import annotations

import re
from typing import Any

from ...results.units import split_key
from .unit_format import quantity

_QUANTITY = re.compile(r"([-+]?[.\d]+(?:e[-+]?\d+)?) (\S+)")
_POWERS = str.maketrans({"2": "²", "3": "³", "^": None})


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
