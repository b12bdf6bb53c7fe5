"""Values of the parts of the bodies that their contact facets take."""

from __future__ import annotations

from typing import NamedTuple


class PartValues(NamedTuple):
    """Values by part of a body; without any they are equal for all.

    Attributes
    ----------
    softness : dict of str to float
        ``(1 - ν²) / E``, or the wear rate that takes its place; only ratios count.
    group : dict of str to int
        Group of equally wearing materials.
    """

    softness: dict[str, float] = {}
    group: dict[str, int] = {}


EQUAL = PartValues()
"""Equal values of all parts."""
