"""Tokens of expressions: numbers, names and signs, each with its position."""

from __future__ import annotations

import re
from dataclasses import dataclass

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
