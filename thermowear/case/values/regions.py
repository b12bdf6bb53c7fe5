"""Regions of space as values of a case file."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import PlainSerializer, PlainValidator

from ...errors import quoted
from ...laws.expressions import Region, parse_region
from .json_schema import WrittenAs, text_such_as
from .units import in_si


def region(text: str) -> Region:
    """Parse a region.

    Raises
    ------
    ValueError
        One-line message with the faulty part of the text.
    """
    return parse_region(text, in_si)


def _read(text: Any) -> Region:
    if isinstance(text, Region):
        return text
    if not isinstance(text, str):
        raise ValueError(f'found {quoted(text)}; needs a text such as "x > 10 mm"')
    return region(text)


RegionOfSpace = Annotated[
    Region,
    PlainValidator(_read),
    PlainSerializer(lambda found: found.text),
    WrittenAs(text_such_as("x > 10 mm")),
]
"""Region by comparisons of lengths in x, y, z and r."""
