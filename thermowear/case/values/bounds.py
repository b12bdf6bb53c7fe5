"""Bounds of what a case may hold, so that every case is read or refused at once.

They are far beyond any real case. Without them a few bytes can keep a parser busy for hours: a
tower of exponents, a key of 200 000 parts, a table within a table a thousand times over.
"""

from __future__ import annotations

import re
from typing import Any

from ...errors import CaseError, quoted

LARGEST_FILE = 2_000_000
"""Bytes of a case file."""
LONGEST_KEY = 200
"""Characters of the name of a key."""
MOST_PARTS = 20
"""Parts of a dotted key, and tables within each other."""
MOST_VALUES = 60_000
"""Values of all keys together, those in lists one by one; histories of 5 000 rows fit in."""
_WIDEST = 1024
"""Bits of a whole number: beyond them it is not even a floating-point number."""

_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?<![\w\\-])(?:{_PART}[ \t]*+\.[ \t]*+){{{MOST_PARTS}}}", re.DOTALL)


def check_keys(text: str, where: str) -> None:
    """Refuse TOML with a dotted key of too many parts, which takes the parser quadratic time.

    Parameters
    ----------
    text : str
    where : str
        What the text is, for the message.

    Raises
    ------
    CaseError
    """
    found = _LONG_KEY.search(text)
    if found is not None:
        line = text.count("\n", 0, found.start()) + 1
        raise CaseError(f"{where}: line {line} has a key of more than {MOST_PARTS} parts")


def check_tables(tables: dict[str, Any]) -> None:
    """Refuse tables that are too deep or too large, and numbers that no key could take.

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
            raise CaseError(f"the case has more than {MOST_VALUES} values; that is the limit")
        for path, value in below:
            if isinstance(value, int) and value.bit_length() > _WIDEST:
                raise CaseError(f"{path}: has more digits than any number that can be used here")
        level = [(path, value) for path, value in below if isinstance(value, dict | list | tuple)]
        if not level:
            return
        if depth == MOST_PARTS:
            raise CaseError(
                f"{level[0][0]}: tables or lists within each other; at most {MOST_PARTS}"
            )


def _parts(path: str, value: Any):
    """The entries of a table or a list, and the path of each."""
    entries = value.items() if isinstance(value, dict) else enumerate(value)
    above = f"{path}." if path else ""
    for key, inner in entries:
        if isinstance(key, str) and len(key) > LONGEST_KEY:
            raise CaseError(
                f"{above}{quoted(key)}: a key of {len(key)} characters; at most {LONGEST_KEY}"
            )
        yield f"{above}{key}", inner
