"""JSON schema of values of a case file whose form there differs from the stored one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import deepcopy
from typing import Any

from pydantic import BaseModel, GetJsonSchemaHandler

UNIT = "x-unit"
"""Key of the SI unit of a quantity, which is written as text with a unit of its dimension."""
A_NAME: dict[str, Any] = {"type": "string"}
LIST_OF_NAMES = {"type": "array", "items": A_NAME}
_WORDS = {"gt": "greater than", "ge": "at least", "le": "at most", "ne": "other than"}
_QUANTITY = r"^\s*[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?\s*(1\s*/\s*)?[^\s\d.]"
"""Number and the first character of its unit.

No two parts match the same text, so that long text is rejected at once.
"""


def quantity_text(unit: str, example: str, **bounds: float) -> dict[str, Any]:
    """Schema of the text of a number with its unit.

    Parameters
    ----------
    unit : str
        SI unit, of which any multiple can be written.
    example : str
    **bounds
        ``gt``, ``ge``, ``le``, ``ne`` in SI.
    """
    limits = {f"x-{_WORDS[word].replace(' ', '-')}": bound for word, bound in bounds.items()}
    text = {"type": "string", "pattern": _QUANTITY, "examples": [example]}
    return text | {UNIT: unit} | limits


def text_such_as(*examples: str, **more: Any) -> dict[str, Any]:
    """Schema of text of a form that a pattern does not describe."""
    return {"type": "string", "examples": list(examples), **more}


class WrittenAs:
    """Form of a value in a case file, in place of the stored value's schema.

    Parameters
    ----------
    schema : dict
    """

    def __init__(self, schema: dict[str, Any]):
        self._schema = schema

    def __get_pydantic_json_schema__(
        self, schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return deepcopy(self._schema)  # pydantic adds the default of each key to it


class OrAlso:
    """Another form of a value, which reading converts to the main one.

    Parameters
    ----------
    schema : dict
    """

    def __init__(self, schema: dict[str, Any]):
        self._schema = schema

    def __get_pydantic_json_schema__(
        self, schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {"anyOf": [deepcopy(self._schema), handler(schema)]}


class AnyOf:
    """One of several forms, or of tables of several types, in place of the stored value's schema.

    Parameters
    ----------
    *forms : dict or type
        Schemas, and classes of tables.
    typed : callable, optional
        Returns classes of tables by the value of their key ``type``; called when the schema is
        made, as laws and geometries are registered when they are imported.
    several : bool
        A list of such forms is allowed, too.
    """

    def __init__(
        self,
        *forms: dict[str, Any] | type[BaseModel],
        typed: Callable[[], Mapping[str, type[BaseModel]]] = dict,
        several: bool = False,
    ):
        self._forms, self._typed, self._several = forms, typed, several

    def __get_pydantic_json_schema__(
        self, schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        found = [
            deepcopy(form) if isinstance(form, dict) else _of(form, handler) for form in self._forms
        ]
        for name, table in self._typed().items():
            found.append(_of(table, handler) | {"properties": {"type": {"const": name}}})
        if self._several:
            found.append({"type": "array", "items": {"anyOf": deepcopy(found)}, "minItems": 1})
        return {"anyOf": found}


def _of(table: type[BaseModel], handler: GetJsonSchemaHandler) -> dict[str, Any]:
    table.model_rebuild()
    return handler(table.__pydantic_core_schema__)
