"""Region of space by comparisons of lengths in the coordinates: ``10 mm < r < 20 mm and x > 0 m``.

::

    region     = comparison { "and" comparison }
    comparison = length ("<" | ">" | "<=" | ">=") length { … }
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .parser import Units, parse_expression
from .tree import Expression

COORDINATES = ("x", "y", "z", "r")
_AND, _SIGN = re.compile(r"\band\b"), re.compile(r"([<>]=?)")


@dataclass(frozen=True)
class Region:
    """Region of space.

    Attributes
    ----------
    text : str
        Text as written.
    sides : tuple of (Expression, Expression)
        Lengths of which the first one must be less than the second one [m].
    """

    text: str
    sides: tuple[tuple[Expression, Expression], ...]

    def depth(self, points: np.ndarray, axisymmetric: bool = False) -> np.ndarray:
        """Least difference of both sides, positive inside the region, shape (n,) [m].

        Parameters
        ----------
        points : ndarray, shape (n, gdim) [m]
        axisymmetric : bool, optional
            True if x is the radius and y the axis; otherwise r is the distance from the z axis.
        """
        x, y = points[:, 0], points[:, 1]
        height = y if axisymmetric else points[:, 2] if points.shape[1] == 3 else np.zeros(len(x))
        radius = x if axisymmetric else np.hypot(x, y)
        at = dict(zip(COORDINATES, (x, y, height, radius), strict=True))
        return np.min([more.value(at) - less.value(at) for less, more in self.sides], axis=0)


def parse_region(text: str, units: Units) -> Region:
    """Parse a region.

    Parameters
    ----------
    text : str
    units : callable
        Map from the text of a unit to its SI factor and dimension.

    Raises
    ------
    ValueError
        One-line message with the faulty part of the text.
    """
    length = units("m", 1.0)[1]
    known = dict.fromkeys(COORDINATES, length)

    def parsed(part: str) -> Expression:
        try:
            return parse_expression(part, known, "m", units)
        except ValueError as error:
            raise ValueError(f'in "{part.strip()}": {error}') from None

    sides: list[tuple[Expression, Expression]] = []
    for comparison in _AND.split(text):
        sides += _compared(comparison, parsed)
    if not any(side.variables for pair in sides for side in pair):
        raise ValueError(f'"{text}" names no coordinate; one of: {", ".join(COORDINATES)}')
    return Region(text, tuple(sides))


def _compared(
    text: str, parsed: Callable[[str], Expression]
) -> list[tuple[Expression, Expression]]:
    """Pairs of the lesser and the greater side of a chain of comparisons."""
    first, *others = _SIGN.split(text)
    if not others:
        raise ValueError(f'"{text.strip()}" compares nothing; write "x > 10 mm" or "a < r < b"')
    found, last = [], parsed(first)
    for sign, part in zip(others[::2], others[1::2], strict=True):
        following = parsed(part)
        found.append((last, following) if sign[0] == "<" else (following, last))
        last = following
    return found
