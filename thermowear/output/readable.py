"""Numbers of the summary in units that suit their size."""

from __future__ import annotations

from ..results.summary_keys import of_key

_UNITS = {
    "Pa": ((1e10, "GPa", 1e-9), (1e4, "MPa", 1e-6), (10.0, "kPa", 1e-3), (0.0, "Pa", 1.0)),
    "m": ((1e-3, "mm", 1e3), (1e-8, "µm", 1e6), (0.0, "nm", 1e9)),
}
"""Units by SI unit: smallest size [SI], unit, and scale from the SI unit."""


def readable_unit(key: str, size: float) -> tuple[str, float]:
    """Readable unit for a number of a size [SI], and its scale from the SI unit."""
    quantity = of_key(key)
    for least, unit, scale in _UNITS.get(quantity.si, ()):
        if abs(size) >= least and size:
            return unit, scale
    return quantity.unit, quantity.drawn(1.0)


def readable(key: str, value: float, unit: str = "") -> tuple[float, str]:
    """Number in a given unit, or else in a readable one, with that unit."""
    quantity = of_key(key).shown_in(unit) if unit else of_key(key)
    if unit or quantity.si not in _UNITS:
        return quantity.drawn(value), quantity.unit
    suited, scale = readable_unit(key, value)
    return scale * value + 0.0, suited
