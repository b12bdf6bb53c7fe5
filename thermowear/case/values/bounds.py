"""Limits on the size of a case, so that any input is read or rejected without delay.

They are far beyond any real case. Without them a few bytes can occupy a parser for hours: a
tower of exponents, a key of 200 000 parts, a thousand nested tables.
"""

from __future__ import annotations

import re
from typing import Any

from ...errors import CaseError, quoted

LARGEST_FILE = 2_000_000
"""Largest size of a case file [bytes]."""
LONGEST_KEY = 200
"""Largest number of characters in a key."""
MOST_PARTS = 20
"""Largest number of parts of a dotted key, and of nested tables."""
MOST_VALUES = 60_000
"""Largest number of values of all keys, list items included; histories of 5 000 rows fit in."""
_WIDEST = 1024
"""Largest number of bits of an integer: beyond it, it does not fit a floating-point number."""

_DEEPEST = 100
"""Largest nesting depth of brackets in TOML, far below the recursion limit of Python."""

_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?<![\w\\-])(?:{_PART}[ \t]*+\.[ \t]*+){{{MOST_PARTS}}}", re.DOTALL)
_QUOTED = re.compile(
    r'"""(?:[^\\]|\\.)*?(?:"""|\Z)|"(?:[^"\\\n]|\\.)*+"?'
    r"|'''.*?(?:'''|\Z)|'[^'\n]*+'?|#[^\n]*",
    re.DOTALL,
)
"""Strings, also unterminated ones, and comments of TOML."""


def check_keys(text: str, where: str) -> None:
    """Reject TOML that the parser takes quadratic time or too many nested calls for.

    Parameters
    ----------
    text : str
    where : str
        Origin of the text, for the message.

    Raises
    ------
    CaseError
    """
    found = _LONG_KEY.search(text)
    if found is not None:
        line = text.count("\n", 0, found.start()) + 1
        raise CaseError(f"{where}: line {line} has a key of more than {MOST_PARTS} parts")
    depth = 0
    for bracket in re.finditer(r"[\[\]{}]", _QUOTED.sub("", text)):
        depth += 1 if bracket[0] in "[{" else -1
        if depth > _DEEPEST:
            raise CaseError(f"{where}: is not valid TOML: brackets nested deeper than {_DEEPEST}")


def check_tables(tables: dict[str, Any]) -> None:
    """Reject tables that are too deep or too large, and integers beyond the range of floats.

    Raises
    ------
    CaseError
        At the first fault.
    """
    count = 0
    level: list[tuple[str, Any]] = [("", tables)]
    for depth in range(MOST_PARTS + 1):
        below = [pair for path, value in level for pair in _parts(path, value)]
        count += len(below)
        if count > MOST_VALUES:
            raise CaseError(f"the case has more than {MOST_VALUES} values, the limit")
        for path, value in below:
            if isinstance(value, int) and value.bit_length() > _WIDEST:
                raise CaseError(f"{path}: the integer has too many digits")
        level = [(path, value) for path, value in below if isinstance(value, dict | list | tuple)]
        if not level:
            return
        if depth == MOST_PARTS:
            raise CaseError(
                f"{level[0][0]}: tables or lists are nested too deeply; at most "
                f"{MOST_PARTS} levels are allowed"
            )


def _parts(path: str, value: Any):
    """Entries of a table or a list, with the path of each."""
    entries = value.items() if isinstance(value, dict) else enumerate(value)
    above = f"{path}." if path else ""
    for key, inner in entries:
        if isinstance(key, str) and len(key) > LONGEST_KEY:
            raise CaseError(
                f"{above}{quoted(key)}: the key has {len(key)} characters; at most "
                f"{LONGEST_KEY} are allowed"
            )
        yield f"{above}{key}", inner
