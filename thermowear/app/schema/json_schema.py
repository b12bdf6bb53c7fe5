"""JSON schema of case files, by which editors complete and check them."""

from __future__ import annotations

from functools import cache
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, models_json_schema

from ...case.assembly.schema import AssemblyCase
from ...case.tables.schema import Case
from ...case.values.json_schema import UNIT
from .meanings import meanings_of, summary_of

DIALECT = "https://json-schema.org/draft/2020-12/schema"
_WITH_UNIT = {
    "type": "object",
    "properties": {
        "values": {"type": "array", "items": {"type": "number"}},
        "unit": {"type": "string"},
    },
    "required": ["values", "unit"],
    "additionalProperties": False,
}
_TYPE = "Selects the kind of this table."


class _Described(GenerateJsonSchema):
    """Schema with the meaning of each key, and lists of numbers with a common unit."""

    def model_schema(self, schema) -> dict[str, Any]:
        found = super().model_schema(schema)
        table = schema["cls"]
        found["description"] = summary_of(getattr(table, "LAW", table))
        names = {field.alias or name: name for name, field in table.model_fields.items()}
        meanings = {"type": _TYPE} | meanings_of(table)
        for key, value in found.get("properties", {}).items():
            value.pop("title", None)
            value["description"] = meanings.get(names[key], "")
        return found

    def nullable_schema(self, schema) -> dict[str, Any]:
        """TOML has no null: a key is left out instead."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema) -> dict[str, Any]:
        """Defaults as they would be written; those of tables are the defaults of their keys."""
        found = super().default_schema(schema)
        default = found.get("default")
        if UNIT in found and default is not None:
            found["default"] = f"{default!r} {found[UNIT]}"
        if default is None or isinstance(default, dict):
            found.pop("default", None)
        return found

    def tuple_schema(self, schema) -> dict[str, Any]:
        found = super().tuple_schema(schema)
        items = found.get("prefixItems", [found.get("items")])
        with_unit = all(isinstance(item, dict) and UNIT in item for item in items)
        return {"anyOf": [found, _WITH_UNIT]} if with_unit else found


@cache
def case_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of a case file of two bodies or of several.

    Text of a quantity has its SI unit as ``x-unit`` and its bounds in SI as ``x-at-least`` and the
    like, which validators ignore.
    """
    kinds = Case, AssemblyCase
    of_each, shared = models_json_schema(
        [(kind, "validation") for kind in kinds],
        schema_generator=_Described,
        title="Case of thermowear",
    )
    return {
        "$schema": DIALECT,
        **shared,
        "anyOf": [of_each[kind, "validation"] for kind in kinds],
    }
