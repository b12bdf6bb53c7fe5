"""Ratios that are written as percentages."""

from __future__ import annotations

import re
from typing import Annotated, Any

from pydantic import BeforeValidator, PlainSerializer

from .json_schema import WrittenAs, text_such_as


def _percentage(value: Any) -> float:
    """Number from text such as ``"1 %"``."""
    found = re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*%\s*", value) if isinstance(value, str) else None
    if found is None or not 0.0 < float(found[1]) <= 100.0:
        raise ValueError('must be more than 0 % and at most 100 %, such as "1 %"')
    return float(found[1]) / 100.0


Percentage = Annotated[
    float,
    BeforeValidator(_percentage),
    PlainSerializer(lambda value: f"{100.0 * value:.12g} %", return_type=str),
    WrittenAs(text_such_as("1 %", pattern=r"^\s*(\d+\.?\d*|\.\d+)\s*%\s*$")),
]
"""Type of a key that holds a ratio, written as a percentage."""
