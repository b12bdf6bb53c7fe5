"""Base class of all tables of a case file, and types of keys without a unit."""

import os
from collections.abc import Callable
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationInfo,
    model_validator,
)

from ...errors import note, quoted

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Switch = Annotated[bool, Field(strict=True)]
FOLDER = "folder"
"""Key of the case file's folder in the validation context."""
MODEL = "model"
"""Key of the model of the case in the validation context of its geometry."""
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

    model_config = ConfigDict(defer_build=True, extra="forbid", frozen=True, validate_default=False)

    @model_validator(mode="before")
    @classmethod
    def _with_units(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            return data
        return {key: _quantities(key, value) for key, value in data.items()}

    def leaves_out(self, key: str) -> bool:
        """True if the table can have a key and does not give it."""
        return key in type(self).model_fields and key not in self.model_fields_set


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


def number_or(*words: Any, where: Callable[[int | float], bool], allowed: str) -> BeforeValidator:
    """Validator of a word or a number, with one message for all other values."""

    def check(value: Any) -> Any:
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if value in words or (number and where(value)):
            return value
        raise ValueError(f"found {quoted(value)}; must be {allowed}")

    return BeforeValidator(check)


def _resolve_path(path: str, info: ValidationInfo) -> str:
    """Absolute path of a file: relative to the folder of the case file, or else to the current one.

    A case without a file of its own (tables in Python) uses the current folder only.
    """
    here = os.path.abspath(path)
    folder = (info.context or {}).get(FOLDER)
    if folder is None:
        return here
    in_folder = os.path.abspath(os.path.join(folder, path))
    if here == in_folder or not os.path.exists(here):
        return in_folder
    if os.path.exists(in_folder):
        note(f"found {in_folder}, next to the case file; the other file {here} is not read")
        return in_folder
    note(
        f"found {here} in the current folder; paths are relative to the folder of the case "
        f"file: {folder}"
    )
    return here


UserFile = Annotated[str, AfterValidator(_resolve_path)]
"""Type of a key that holds the path of a file, made absolute."""
