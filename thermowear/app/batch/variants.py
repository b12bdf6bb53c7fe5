"""Variants of a case: all combinations of values of keys, validated before anything is computed."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ... import load
from ...errors import CaseError
from ...interrupts import DeferredSignals
from .computing import start_petsc

if TYPE_CHECKING:
    from ...case import AnyCase

_PAIRS = {"[": "]", "{": "}"}
_QUOTES = "\"'"


@dataclass(frozen=True)
class Variant:
    """Case for one combination of values.

    Attributes
    ----------
    number : int
        Number of the variant, from 1.
    values : dict of str to str
        Values by key, as given by the user.
    case : AnyCase
    """

    number: int
    values: dict[str, Any]
    case: AnyCase


def variants(
    source: str | Path | dict[str, Any],
    over: Mapping[str, Sequence[Any]],
    overrides: tuple[str, ...] = (),
) -> list[Variant]:
    """Validate all combinations of values of keys; the last key varies fastest.

    Parameters
    ----------
    source : str, Path or dict
        Case file, or its tables.
    over : mapping of str to sequence
        Values by key path, as from `parse_over`.
    overrides : tuple of str
        Changes ``KEY=VALUE`` of all variants.

    Raises
    ------
    CaseError
        One line per fault with its variant; faults common to all variants are reported once.
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
        lines: list[str] = []
        for line, where in faults.items():
            common = len(where) == len(combinations)
            lines += [line] if common else [f"{variant}: {line}" for variant in where]
        raise CaseError(*lines)
    return found


def grouped(cases: Iterable[AnyCase]) -> list[list[int]]:
    """Numbers of the cases that share set-up results; see `simulation.analyses.run.groups`."""
    with DeferredSignals():
        start_petsc(alone=True)
        from ...simulation.analyses.run import groups
        from ...simulation.from_case import model_of

    return groups(model_of(case) for case in cases)


def parse_over(texts: Sequence[str]) -> dict[str, list[str]]:
    """Parse ``KEY=V1,V2,...``; commas within brackets or quotes do not separate values.

    Raises
    ------
    CaseError
        If a text is malformed, or a key is repeated.
    """
    over: dict[str, list[str]] = {}
    for text in texts:
        key, equals, values = text.partition("=")
        key = key.strip()
        listed = [value.strip() for value in _split(values)]
        if not equals or not key or not all(listed):
            raise CaseError(f"--over {text}: must be KEY=V1,V2,..., such as mesh.degree=4,6,8")
        if key in over:
            raise CaseError(f"--over {text}: {key} is given twice")
        over[key] = listed
    return over


def _split(text: str) -> list[str]:
    """Split at commas that are not within brackets or quotes."""
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
    """Format a value as in a case file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(k)} = {written(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(written, value)) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
