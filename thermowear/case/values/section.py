"""Base class of all tables of a case file."""

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, model_validator

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Switch = Annotated[bool, Field(strict=True)]
Fault = tuple[str, str]
"""Path of the key at fault, and the message."""


class KeyFault(ValueError):
    """Fault found by comparing keys of one table, reported at one of them."""

    def __init__(self, key: str, text: str):
        self.key = key
        super().__init__(text)


class Section(BaseModel):
    """Table of the case file: no unknown keys, immutable once read.

    A list of quantities may be written as its numbers and their common unit:
    ``time = { values = [0, 1, 2], unit = "s" }``.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, validate_default=False)

    @model_validator(mode="before")
    @classmethod
    def _with_units(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            return data
        return {key: _quantities(key, value) for key, value in data.items()}


def _quantities(key: str, value: Any) -> Any:
    """List of quantities from numbers and a common unit; other values unchanged."""
    if not isinstance(value, dict) or not value.keys() >= {"values", "unit"}:
        return value
    for other in value.keys() - {"values", "unit"}:
        raise KeyFault(
            f"{key}.{other}", "unknown key; a list with a common unit has the keys values and unit"
        )
    numbers, unit = value["values"], value["unit"]
    if not isinstance(unit, str) or not unit.strip():
        raise KeyFault(f"{key}.unit", 'must be the common unit of all values, such as "s"')
    if not isinstance(numbers, list):
        raise KeyFault(f"{key}.values", "must be a list of numbers")
    for i, number in enumerate(numbers):
        if isinstance(number, bool) or not isinstance(number, int | float):
            raise KeyFault(
                f"{key}.values.{i}", "must be a number without unit, which is given by the key unit"
            )
    return [f"{number!r} {unit}" for number in numbers]
