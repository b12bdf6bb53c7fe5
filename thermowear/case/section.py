"""What all tables of a case file have in common."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Switch = Annotated[bool, Field(strict=True)]


class Section(BaseModel):
    """A table of the case file: no unknown keys, no changes once read."""

    model_config = ConfigDict(extra="forbid", frozen=True, validate_default=False)


class KeyFault(ValueError):
    """A fault found by comparing keys of one table, charged to one of them."""

    def __init__(self, key: str, text: str):
        self.key = key
        super().__init__(text)
