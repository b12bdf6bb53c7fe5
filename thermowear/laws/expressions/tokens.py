"""Tokens of expressions with their positions; units of numbers, and their dimensions.

Units are in the notation of the case file, ``W/(m^2 K)``::

    unit     = [ [ "1" ] "/" factor | name ] { ( "*" | "/" ) factor | name }
    factor   = name | "(" factor { ( "*" | "/" ) factor | name } ")" [ exponent ]
    name     = a word with an optional exponent, no variable and no function

All repetitions in them are possessive: the time is proportional to the length of the text.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import lru_cache

LONGEST = 1000
"""Largest number of characters of an expression."""
NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_TOKEN = re.compile(
    rf"(?P<number>{NUMBER})"
    r"|(?P<name>[A-Za-z_]\w*)"
    r"|(?P<sign>\*\*|[-+*/^(),])"
    r"|(?P<space>\s+)",
    re.ASCII,
)
_SIGNED = rf"[-+]?\s*{NUMBER}"
_EXPONENT = rf"(?:\s*(?:\^|\*\*)\s*(?:{_SIGNED}|\(\s*{_SIGNED}\s*(?:/\s*{_SIGNED}\s*)?\)))?+"
_LEVELS = 2
"""Largest nesting depth of parentheses in a unit."""
_POWER = re.compile(r"\s*(?:\^|\*\*)")
_SAME = 1e-9
_SHOWN = 6  # digits of an exponent in messages
_NAME_AT_END = re.compile(r"(?<![\w.])[A-Za-z_]\w*\Z", re.ASCII)


@dataclass(frozen=True)
class Token:
    """Token of an expression.

    Attributes
    ----------
    kind : str
        ``"number"``, ``"name"``, ``"sign"`` or ``"end"``.
    text : str
        Text; both notations of a power become ``"^"``.
    start, end : int
        Positions of the first character and after the last one, from 0.
    """

    kind: str
    text: str
    start: int
    end: int


def fault(position: int, text: str) -> ValueError:
    """Error for a fault at a position, counted from 0."""
    return ValueError(f"at character {position + 1}: {text}")


def tokens(text: str) -> list[Token]:
    """Split an expression into tokens; the last one marks the end.

    Raises
    ------
    ValueError
        If it is too long, or contains an invalid character.
    """
    if len(text) > LONGEST:
        raise ValueError(f"has {len(text)} characters; an expression has at most {LONGEST}")
    found, position = [], 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise fault(position, _unknown(text[position]))
        kind = match.lastgroup or ""
        if kind != "space":
            written = "^" if match[0] == "**" else match[0]
            found.append(Token(kind, written, position, match.end()))
        position = match.end()
    return [*found, Token("end", "", len(text), len(text))]


def _unknown(character: str) -> str:
    if character.isascii():
        return f"{character!r} cannot stand in an expression"
    return (
        f"{character!r} (U+{ord(character):04X}) cannot stand in an expression; write it in ASCII"
    )


def unit_end(text: str, start: int, variables: Collection[str]) -> int:
    """Position after the unit that begins at a position; the same position without unit.

    Raises
    ------
    ValueError
        If the exponent of a unit is not a number.
    """
    found = _pattern(tuple(variables)).match(text, start)
    if found is None:
        return start
    power = _POWER.match(text, found.end())
    if power is not None and _NAME_AT_END.search(found[0]):
        raise fault(power.end() - len(power[0].lstrip()), "the exponent of a unit must be a number")
    return found.end()


@lru_cache
def _pattern(variables: tuple[str, ...]) -> re.Pattern[str]:
    name = rf"(?!(?:{'|'.join(variables)})\b)[A-Za-z_]\w*+(?!\s*\(){_EXPONENT}"
    factor = name
    for _ in range(_LEVELS):
        factors = rf"(?:\s*[*/]\s*{factor}|\s*{name})*+"
        factor = rf"(?:{name}|\(\s*{factor}{factors}\s*\){_EXPONENT})"
    factors = rf"(?:\s*[*/]\s*{factor}|\s*{name})*+"
    return re.compile(rf"\s*(?:(?:1\s*)?/\s*{factor}|{name}){factors}", re.ASCII)


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
