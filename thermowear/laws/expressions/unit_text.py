"""Extent of the unit after a number, in the notation of the case file: ``W/(m^2 K)``.

::

    unit     = [ [ "1" ] "/" factor | name ] { ( "*" | "/" ) factor | name }
    factor   = name | "(" factor { ( "*" | "/" ) factor | name } ")" [ exponent ]
    name     = a word with an optional exponent, no variable and no function

All repetitions are possessive, so that the time is proportional to the length of the text.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from functools import lru_cache

from .tokens import NUMBER, fault

_SIGNED = rf"[-+]?\s*{NUMBER}"
_EXPONENT = rf"(?:\s*(?:\^|\*\*)\s*(?:{_SIGNED}|\(\s*{_SIGNED}\s*(?:/\s*{_SIGNED}\s*)?\)))?+"
_LEVELS = 2
"""Largest nesting depth of parentheses in a unit."""
_POWER = re.compile(r"\s*(?:\^|\*\*)")
_NAME_AT_END = re.compile(r"(?<![\w.])[A-Za-z_]\w*\Z", re.ASCII)


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
