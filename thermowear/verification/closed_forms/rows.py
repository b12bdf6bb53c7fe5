"""Common rows of checks."""

from __future__ import annotations

from ..check import Check, compare, compare_worst
from .patches import SpecialCase

CLOSED_FORM = "Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895, closed form"
TABLE = "closed form, tabulated"
EXPONENTS = (0.5, 1.0, 2.0)
MPA = 1e6
_ROUNDED = 1 + 1e-9  # relative to half a unit: allows ties in rounding


def printed(quantity: str, computed: float, text: str) -> Check:
    """Compare a number with a tabulated one, to half a unit of its last digit."""
    mantissa, _, power = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    half_unit = 0.5 * 10.0 ** (int(power or 0) - decimals)
    known = float(text)
    return compare(quantity, computed, known, half_unit / abs(known) * _ROUNDED, TABLE)


def worst(quantity: str, computed, exact, allowed: float = 1e-9) -> Check:
    """Compare values at points with a formula, at the point of largest deviation."""
    quantity = f"{quantity}, at the point of largest deviation"
    return compare_worst(quantity, computed, exact, allowed, CLOSED_FORM)


def dissipation(case: SpecialCase, name: str) -> Check:
    """Compare ``D_w = ∫ p·w' dS`` with the power of the load, ``F·V``."""
    steady = case.steady()
    quantity = f"wear dissipation power{name} [W]"
    power = float(case.load @ steady.velocity)
    return compare(quantity, steady.dissipation, power, 1e-9, "D_w = F·V")
