"""Variants of a case: all combinations of values of keys, checked before anything runs."""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import load
from ..errors import CaseError

if TYPE_CHECKING:
    from ..case import Case

_PAIRS = {"[": "]", "{": "}"}
_QUOTES = "\"'"


@dataclass(frozen=True)
class Variant:
    """One combination of values.

    Attributes
    ----------
    number : int
        From 1.
    values : dict of str to str
        By key, as they were written.
    case : Case
    """

    number: int
    values: dict[str, Any]
    case: Case


def variants(
    source: str | Path | dict[str, Any],
    over: Mapping[str, Sequence[Any]],
    overrides: tuple[str, ...] = (),
) -> list[Variant]:
    """All combinations of values of keys; the last key changes fastest.

    Parameters
    ----------
    source : str, Path or dict
        A case file, or its tables.
    over : mapping of str to sequence
        Values by the path of their key, as in `parse_over`.
    overrides : tuple of str
        ``KEY=VALUE``, the same in all variants.

    Raises
    ------
    CaseError
        One line per fault, with the variant; what is wrong with all of them is said once.
    """
    found: list[Variant] = []
    faults: dict[str, list[str]] = {}
    combinations = list(itertools.product(*over.values()))
    for number, values in enumerate(combinations, 1):
        chosen = dict(zip(over, values, strict=True))
        changes = tuple(f"{key}={value}" for key, value in chosen.items())
        try:
            found.append(Variant(number, chosen, load(source, overrides + changes)))
        except CaseError as error:
            for line in error.faults:
                faults.setdefault(line, []).append(f"variant {number} ({', '.join(changes)})")
    if faults:
        raise CaseError(*_lines(faults, len(combinations)))
    return found


def _lines(faults: dict[str, list[str]], count: int) -> list[str]:
    lines = []
    for line, where in faults.items():
        lines += [line] if len(where) == count else [f"{variant}: {line}" for variant in where]
    return lines


def parse_over(texts: Sequence[str]) -> dict[str, list[str]]:
    """Keys and their values from ``KEY=V1,V2,...``; commas within brackets or quotes do not count.

    Raises
    ------
    CaseError
    """
    over: dict[str, list[str]] = {}
    for text in texts:
        key, equals, values = text.partition("=")
        key = key.strip()
        listed = [value.strip() for value in _split(values)]
        if not equals or not key or not all(listed):
            raise CaseError(f"--over {text}: must be KEY=V1,V2,..., such as mesh.degree=4,6,8")
        if key in over:
            raise CaseError(f"--over {text}: {key} is there twice")
        over[key] = listed
    return over


def _split(text: str) -> list[str]:
    """Parts between commas that are not within brackets or quotes."""
    parts, closing, quote = [""], [], ""
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in _QUOTES:
            quote = character
        elif character in _PAIRS:
            closing.append(_PAIRS[character])
        elif closing and character == closing[-1]:
            closing.pop()
        elif character == "," and not closing:
            parts.append("")
            continue
        parts[-1] += character
    return parts


def written(value: Any) -> str:
    """A value as it would be written in a case file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(k)} = {written(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(written, value)) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
