"""Physical dimensions as exponents of base units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

_SAME = 1e-9
_SHOWN = 6  # digits of an exponent in messages


@dataclass(frozen=True)
class Dimension:
    """Dimension of a quantity.

    Attributes
    ----------
    powers : tuple of (str, float)
        SI base unit and its exponent, sorted by name; exponents of 0 are left out.
    """

    powers: tuple[tuple[str, float], ...] = ()

    @classmethod
    def of(cls, powers: Mapping[str, float]) -> Dimension:
        """Dimension with given exponents of SI base units."""
        kept = {unit: float(power) for unit, power in powers.items() if abs(power) > _SAME}
        return cls(tuple(sorted(kept.items())))

    @property
    def none(self) -> bool:
        """True if the quantity is dimensionless."""
        return not self.powers

    def times(self, other: Dimension, power: float = 1.0) -> Dimension:
        """Dimension of the product with another quantity, raised to a power."""
        powers = dict(self.powers)
        for unit, exponent in other.powers:
            powers[unit] = powers.get(unit, 0.0) + power * exponent
        return Dimension.of(powers)

    def to(self, power: float) -> Dimension:
        """Dimension of the quantity raised to a power."""
        return Dimension().times(self, power)

    def same(self, other: Dimension) -> bool:
        """Equality up to rounding of the exponents."""
        return self.times(other, -1.0).none

    def __str__(self) -> str:
        """Text in SI base units, such as ``kg/(m s^2)``."""
        above = [_written(unit, power) for unit, power in self.powers if power > 0]
        below = [_written(unit, -power) for unit, power in self.powers if power < 0]
        if not below:
            return " ".join(above) or "1"
        under = below[0] if len(below) == 1 else f"({' '.join(below)})"
        return f"{' '.join(above) or '1'}/{under}"


def _written(unit: str, power: float) -> str:
    return unit if abs(power - 1) <= _SAME else f"{unit}^{power:.{_SHOWN}g}"
