"""Keys of case files: their meanings, the JSON schema for editors, rows for the reference."""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema, models_json_schema

from ..case.assembly.schema import AssemblyCase
from ..case.tables.schema import Case
from ..case.values.json_schema import UNIT

_TITLE = re.compile(r"^Attributes\n-+\n", re.MULTILINE)
_ENTRY = re.compile(r"^(?P<names>\w+(?:, \w+)*)(?: : .*)?\n(?P<text>(?:(?: .*)?\n)*)", re.MULTILINE)
_REFERENCE = re.compile(r"`((?:model|laws)\.[a-z_.]+\.[A-Z]\w*)`")
_ALONE = re.compile(r"See `((?:model|laws)\.[a-z_.]+\.[A-Z]\w*)`[.;]?(.*)", re.DOTALL)
_UNIT = re.compile(r"\s*\[[^\]]*\](?: and \[[^\]]*\])?(?=\.?$)")
_KEY = re.compile(r"^Key ``?(\w+)``?: ")


def meanings_of(table: type[BaseModel]) -> dict[str, str]:
    """Meaning of each key that is described.

    A key without a description of its own has that of the attribute of the same name in a class
    that the docstring of the table refers to, such as ``model.body.Material``.

    Parameters
    ----------
    table : type

    Returns
    -------
    dict of str to str
        Sentences by the name of the field.
    """
    described: dict[str, str] = {}
    referred: list[str] = []
    law = getattr(table, "LAW", table)  # the table of a registered law has no text of its own
    for base in (law, *table.__mro__):
        if base in (BaseModel, object) or not base.__doc__:
            continue
        described = _attributes(base) | described
        referred += _REFERENCE.findall(inspect.cleandoc(base.__doc__))
    for name in referred:
        described = _of_class(name) | described
    fields = table.model_fields
    return {key: _tidy(text) for key, text in described.items() if key in fields and text}


def summary_of(table: type) -> str:
    """First paragraph of the docstring of a class."""
    return inspect.cleandoc(table.__doc__ or "").partition("\n\n")[0].replace("\n", " ")


def _of_class(name: str) -> dict[str, str]:
    """Attributes of a class of this package and of its bases, by a name such as ``laws.a.B``."""
    module, _, found = name.rpartition(".")
    kind = getattr(importlib.import_module(f"thermowear.{module}"), found)
    attributes: dict[str, str] = {}
    for base in kind.__mro__[:-1]:
        attributes = _attributes(base) | attributes
    return attributes


def _attributes(kind: type) -> dict[str, str]:
    """Texts of the section ``Attributes`` of a docstring, by name."""
    text = inspect.cleandoc(kind.__doc__ or "") + "\n"
    title = _TITLE.search(text)
    if title is None:
        return {}
    found: dict[str, str] = {}
    for entry in _ENTRY.finditer(text, title.end()):
        sentence = " ".join(entry["text"].split())
        elsewhere = _ALONE.fullmatch(sentence)
        for name in entry["names"].split(", "):
            there = _of_class(elsewhere[1]).get(name, "") if elsewhere else sentence
            found[name] = there + elsewhere[2] if elsewhere and there else there
    return found


def _tidy(text: str) -> str:
    """Sentence of a table of keys: without units, which the type of the key has."""
    text = _KEY.sub("", _UNIT.sub("", text))
    text = text[0].upper() + text[1:] if text else text
    return text if text.endswith((".", ":")) or not text else f"{text}."


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


NAME = "NAME"
"""Part of a path that is a name chosen in the case."""
_EACH_BODY = "Table of a body, by its name in the geometry."
_TYPES = {
    "string": "text",
    "number": "number",
    "integer": "whole number",
    "boolean": "true, false",
}
_LIMITS = {
    "x-greater-than": "> {}",
    "x-at-least": "≥ {}",
    "x-at-most": "≤ {}",
    "x-other-than": "≠ {}",
    "exclusiveMinimum": "> {}",
    "minimum": "≥ {}",
    "exclusiveMaximum": "< {}",
    "maximum": "≤ {}",
}


@dataclass(frozen=True)
class Key:
    """Key of a table.

    Attributes
    ----------
    name : str
    kinds : tuple of str
        What it may hold: quantities by their SI unit in brackets, tables as `TableOfKeys.name`
        between angle brackets.
    default : str
        Value without the key; empty if there is none, ``required`` if it must be given.
    limits : str
        Bounds of the value, of quantities in SI.
    meaning : str
    """

    name: str
    kinds: tuple[str, ...]
    default: str
    limits: str
    meaning: str


@dataclass(frozen=True)
class TableOfKeys:
    """Table of a case file.

    Attributes
    ----------
    name : str
    paths : tuple of str
        Where it occurs in the file.
    meaning : str
    keys : tuple of Key
    """

    name: str
    paths: tuple[str, ...]
    meaning: str
    keys: tuple[Key, ...]


def all_tables() -> dict[str, TableOfKeys]:
    """Tables of case files by name, in the order of the keys that contain them."""
    schema = case_schema()
    definitions = schema["$defs"]
    paths: dict[str, list[str]] = {}
    waiting = [(form["$ref"].rpartition("/")[2], "") for form in schema["anyOf"]]
    for name, path in waiting:  # grows while it is read
        known = paths.setdefault(name, [])
        if path in known:
            continue
        known.append(path)
        for key, value in _properties(definitions[name]).items():
            waiting += [(table, f"{path}{inside}") for table, inside in _tables(value, f".{key}")]
        extra = definitions[name].get("additionalProperties")
        if isinstance(extra, dict):
            waiting += [(table, f"{path}{at}") for table, at in _tables(extra, f".{NAME}")]
    return {name: _table(name, tuple(found), definitions[name]) for name, found in paths.items()}


def _properties(definition: dict[str, Any]) -> dict[str, Any]:
    """Keys of a table, of one that may also be the name of a file, too."""
    for form in (definition, *definition.get("anyOf", ())):
        if "properties" in form:
            return form["properties"]
    return {}


def _tables(value: dict[str, Any], path: str) -> Iterator[tuple[str, str]]:
    """Tables that a value may be or contain, and their paths."""
    if "$ref" in value:
        yield value["$ref"].rpartition("/")[2], path
    for form in (*value.get("anyOf", ()), *value.get("oneOf", ())):
        yield from _tables(form, path)
    for key, inside in (("additionalProperties", f"{path}.{NAME}"), ("items", f"{path}[]")):
        if isinstance(value.get(key), dict):
            yield from _tables(value[key], inside)


def _table(name: str, paths: tuple[str, ...], definition: dict[str, Any]) -> TableOfKeys:
    form = next(f for f in (definition, *definition.get("anyOf", ())) if "properties" in f)
    required = form.get("required", ())
    keys = tuple(_key(key, value, required) for key, value in form["properties"].items())
    extra = form.get("additionalProperties")
    if isinstance(extra, dict):
        keys = (Key(NAME, tuple(_kinds(extra)), "", "", _EACH_BODY), *keys)
    return TableOfKeys(name, tuple(path[1:] for path in paths), form["description"], keys)


def _key(name: str, value: dict[str, Any], required) -> Key:
    default = "required" if name in required else _text(value.get("default"))
    kinds = tuple(dict.fromkeys(_kinds(value)))
    return Key(name, kinds, default, _limits(value), value.get("description", ""))


def _text(default: Any) -> str:
    if default is None or default == []:
        return ""
    return str(default).lower() if isinstance(default, bool) else str(default)


def _kinds(value: dict[str, Any]) -> Iterator[str]:
    """Forms of a value, in words."""
    if "$ref" in value:
        yield f"<{value['$ref'].rpartition('/')[2]}>"
    elif "anyOf" in value or "oneOf" in value:
        for form in (*value.get("anyOf", ()), *value.get("oneOf", ())):
            yield from _kinds(form)
    elif "enum" in value or "const" in value:
        yield from (f'"{word}"' if isinstance(word, str) else str(word) for word in _words(value))
    elif UNIT in value:
        yield f"[{value[UNIT]}]"
    elif value.get("type") == "array":
        items = value.get("prefixItems") or [value["items"]]
        each = dict.fromkeys(kind for item in items for kind in _kinds(item))
        count = f"{len(items)} of " if "prefixItems" in value else ""
        yield f"list of {count}{' or '.join(each)}"
    elif "additionalProperties" in value and isinstance(value["additionalProperties"], dict):
        yield f"{NAME} = {' or '.join(_kinds(value['additionalProperties']))}"
    else:
        yield from _simple(value)


def _words(value: dict[str, Any]) -> list[Any]:
    return value["enum"] if "enum" in value else [value["const"]]


_SIMPLE = {
    "string": "text",
    "number": "number",
    "integer": "whole number",
    "boolean": "true, false",
}


def _simple(value: dict[str, Any]) -> Iterator[str]:
    types = value.get("type", "object")
    for kind in types if isinstance(types, list) else [types]:
        example = next(iter(value.get("examples", ())), None)
        like = f", such as {example}" if kind == "string" and isinstance(example, str) else ""
        yield f"{_TYPES.get(kind, 'table')}{like}"


def _limits(value: dict[str, Any]) -> str:
    """Bounds of a value or of the values of a list, without those that only exclude overflows."""
    found: dict[str, None] = {}
    forms = [value]
    for form in forms:
        forms += [*form.get("anyOf", ()), *form.get("prefixItems", ())]
        forms += [form[key] for key in ("items",) if isinstance(form.get(key), dict)]
        for key, text in _LIMITS.items():
            if (key in form and 1e-9 < abs(form[key]) < 1e6) or form.get(key) == 0:
                found[text.format(f"{form[key]:g}")] = None
    return ", ".join(found)
