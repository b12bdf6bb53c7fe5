"""Names of usual units, for messages about unknown ones."""

from __future__ import annotations

import difflib
from typing import Any

from ...errors import quoted

_USUAL = (
    *("Pa", "kPa", "MPa", "GPa", "bar", "N", "kN", "MN", "m", "mm", "cm", "km", "um", "µm", "nm"),
    *("s", "ms", "min", "h", "Hz", "kHz", "K", "degC", "degF", "W", "mW", "kW", "MW", "J", "mJ"),
    *("kJ", "MJ", "kg", "g", "mol", "rad", "mrad", "deg", "turn", "rpm", "inch", "psi", "ksi"),
)
"""Units that a misspelt one is compared with."""


def unknown_unit(error: Exception) -> str:
    """Addition to a message: the unknown unit of an error of pint, with units of a similar name."""
    import pint

    if not isinstance(error, pint.UndefinedUnitError):
        return ""
    names = error.unit_names
    name = names if isinstance(names, str) else min(names)
    return f": unknown unit {quoted(name)}{similar_units(name)}"


def without_offset(value: Any) -> str:
    """Proposal for messages, instead of a quantity of pint on a scale with an offset."""
    if not value.check("[temperature]"):
        return "it in another unit"
    return f"temperatures in K: {value.to('K').magnitude:.9g} K"


def similar_units(name: str) -> str:
    """Addition to a message: usual units of a similar name; empty without any."""
    folded = name.casefold()
    found = [unit for unit in _USUAL if unit.casefold() == folded]
    if not found:
        words = {unit.casefold(): unit for unit in reversed(_USUAL)}
        found = [words[close] for close in difflib.get_close_matches(folded, words, n=2)]
    return f", perhaps {' or '.join(found)}" if found else ""
