"""All keys of case files as rows of tables, for their reference."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ...case.values.json_schema import UNIT
from .json_schema import case_schema

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
