"""Meanings of the keys of a table, from the docstrings of its class and of the model's."""

from __future__ import annotations

import importlib
import inspect
import re

from pydantic import BaseModel

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
