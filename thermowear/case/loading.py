"""Reading of a case file with overrides; validation errors become one line per fault.

Limits on its size, so that any input is read or rejected without delay, are far beyond any real
case. Without them a few bytes can occupy a parser for hours: a tower of exponents, a key of 200 000
parts, a thousand nested tables.
"""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args, get_type_hints

from pydantic import ValidationError

from ..errors import MOST_FAULTS, CaseError, quoted, shortened
from ..user_files import read_text
from .any_case import AnyCase
from .assembly.geometry import known_assemblies
from .assembly.schema import AssemblyCase
from .tables.geometry_choice import known_geometries
from .tables.schema import Case
from .validation.assembly import check as check_assembly
from .validation.checks import check
from .values.section import FOLDER, KeyFault, Section

LARGEST_FILE = 2_000_000
"""Largest size of a case file [bytes]."""
LONGEST_KEY = 200
"""Largest number of characters in a key."""
MOST_PARTS = 20
"""Largest number of parts of a dotted key, and of nested tables."""
MOST_VALUES = 60_000
"""Largest number of values of all keys, list items included; histories of 5 000 rows fit in."""
_WIDEST = 1024
"""Largest number of bits of an integer: beyond it, it does not fit a floating-point number."""

_DEEPEST = 100
"""Largest nesting depth of brackets in TOML, far below the recursion limit of Python."""

_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?<![\w\\-])(?:{_PART}[ \t]*+\.[ \t]*+){{{MOST_PARTS}}}", re.DOTALL)
_QUOTED = re.compile(
    r'"""(?:[^\\]|\\.)*?(?:"""|\Z)|"(?:[^"\\\n]|\\.)*+"?'
    r"|'''.*?(?:'''|\Z)|'[^'\n]*+'?|#[^\n]*",
    re.DOTALL,
)
"""Strings, also unterminated ones, and comments of TOML."""
_MESSAGES = {
    "missing": "missing",
    "greater_than": "must be greater than {gt}",
    "greater_than_equal": "must be at least {ge}",
    "less_than": "must be less than {lt}",
    "less_than_equal": "must be at most {le}",
    "literal_error": "must be {expected}",
    "float_type": "must be a number",
    "finite_number": "must be a finite number",
    "int_type": "must be a whole number",
    "int_from_float": "must be a whole number",
    "bool_type": "must be true or false",
    "string_type": "must be text in quotation marks",
    "model_type": "must be a table",
    "model_attributes_type": "must be a table",
    "dict_type": "must be a table",
    "tuple_type": "must be a list",
    "too_long": "must have at most {max_length} values",
}

_REQUIRED = {
    "model": "must be 'axisymmetric', 'plane-strain', 'plane-stress' or '3d'",
    "geometry": 'needs a type, such as [geometry] type = "file" (a mesh) or one of the starters',
    "bodies": "needs the material of each body: [bodies.NAME] young_modulus = ...",
    "load": "needs one of load.force, load.mean_pressure and load.approach",
    "analysis": 'needs a type, such as [analysis] type = "steady"',
}
"""Contents of the required tables and keys of a case, for messages."""
_ANALYSES = "'initial', 'steady', 'transient', 'fretting', 'reciprocating', 'stability'"


def load(source: str | Path | dict[str, Any], overrides: tuple[str, ...] = ()) -> AnyCase:
    """Read and check a case.

    Parameters
    ----------
    source : str, Path or dict
        Case file, or its tables. Relative paths in a file refer to its folder, otherwise (with a
        warning) to the current one, as do those in tables.
    overrides : tuple of str
        ``KEY=VALUE`` each, with the key's path (``mesh.degree=6``); the value is a TOML value or
        plain text.

    Returns
    -------
    Case or AssemblyCase

    Raises
    ------
    CaseError
        One line per fault.
    """
    tables = source if isinstance(source, dict) else _read(Path(source))
    context = None if isinstance(source, dict) else {FOLDER: str(Path(source).absolute().parent)}
    for text in overrides:
        tables = _override(tables, text)
    check_tables(tables)
    kind = AssemblyCase if _is_assembly(tables) else Case
    try:
        case = kind.model_validate(tables, context=context)
    except ValidationError as error:
        found = error.errors(include_url=False)
        lines = [_message(fault, kind) for fault in found[:MOST_FAULTS]]
        raise CaseError(*lines, more=len(found) - len(lines)) from None
    if isinstance(case, AssemblyCase):
        check_assembly(case)
    else:
        check(case)
    return case


def _is_assembly(tables: dict[str, Any]) -> bool:
    """Test for a case of several bodies, which has tables of contacts and holders."""
    geometry = tables.get("geometry")
    kind = geometry.get("type") if isinstance(geometry, dict) else None
    only = known_assemblies().keys() - known_geometries().keys()
    return bool(tables.keys() & {"holders", "contacts"}) or (isinstance(kind, str) and kind in only)


def _read(path: Path) -> dict[str, Any]:
    try:
        text = read_text(path, LARGEST_FILE)
    except OSError as error:
        raise CaseError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise CaseError(f"{path}: {error}") from None
    check_keys(text, str(path))
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # numbers or nesting beyond Python's limits too
        raise CaseError(f"{path}: is not valid TOML: {error}") from None


def _override(tables: dict[str, Any], text: str) -> dict[str, Any]:
    """Copy of the tables with one key set."""
    key, equals, value = text.partition("=")
    path = [part.strip() for part in key.split(".")]
    given = f"--set {shortened(text, 100)}"
    if not equals or not all(path):
        raise CaseError(f"{given}: must be KEY=VALUE, such as mesh.degree=6")
    if len(path) > MOST_PARTS:
        raise CaseError(f"{given}: the key has {len(path)} parts; at most {MOST_PARTS} are allowed")
    parsed = _value(given, value)
    result = table = dict(tables)
    for part in path[:-1]:
        below = table.get(part, {})
        if not isinstance(below, dict):
            raise CaseError(f"{given}: {part} is not a table")
        table[part] = dict(below)
        table = table[part]
    table[path[-1]] = parsed
    return result


def _value(given: str, text: str) -> Any:
    """Value of ``--set KEY=VALUE``: a TOML value, or plain text.

    Raises
    ------
    CaseError
        If the text holds more than one value: further lines would set keys silently.
    """
    check_keys(text, given)
    try:
        parsed = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text.strip()
    if len(parsed) > 1:
        raise CaseError(f"{given}: contains a second key after a line break; use one --set per key")
    return parsed["value"]


def _message(fault: Any, kind: type[Section]) -> str:
    """Message of one fault: the key's path, the value found, the values allowed."""
    location = fault["loc"]
    if location[:1] == ("analysis",):
        location = (*location[:1], *location[2:])  # pydantic puts the type of analysis second
    path = ".".join(map(str, location))
    if fault["type"] == "union_tag_not_found":
        return f"{path}.type: missing; must be one of {_ANALYSES}"
    if fault["type"] == "union_tag_invalid":
        return f"{path}.type: found {quoted(fault['input']['type'])}; must be one of {_ANALYSES}"
    if fault["type"] == "value_error":
        error = fault["ctx"]["error"]
        key = (error.key,) if isinstance(error, KeyFault) else ()
        return f"{'.'.join(map(str, (*location, *key)))}: {error}"
    if fault["type"] == "extra_forbidden":
        return f"{path}: unknown key{_suggestion(location, kind)}"
    message = _MESSAGES.get(fault["type"], fault["msg"]).format(**fault.get("ctx", {}))
    if fault["type"] == "missing" and path in _REQUIRED:
        return f"{path}: missing; {_REQUIRED[path]}"
    if fault["type"] == "missing" or isinstance(fault["input"], dict):
        return f"{path}: {message}"
    return f"{path}: found {quoted(fault['input'])}; {message}"


def _suggestion(location: tuple[Any, ...], kind: type[Section]) -> str:
    """Hint at the most similar known key of the same tables."""
    table = kind.model_fields.get(location[0])
    sections = _sections(table.annotation) if table else (kind,)
    words = {
        field.alias or name for section in sections for name, field in section.model_fields.items()
    }
    if location[-1] in words:
        return " here"
    close = difflib.get_close_matches(str(location[-1]), sorted(words), n=1)
    return f"; did you mean {close[0]}?" if close else f"; known: {', '.join(sorted(words))}"


def _sections(annotation: Any) -> Iterator[type[Section]]:
    """Tables named in an annotation, and the tables nested in them."""
    for part in get_args(annotation):
        yield from _sections(part)
    if isinstance(annotation, type) and issubclass(annotation, Section):
        yield annotation
        for kind in annotation.__subclasses__():
            yield from _sections(kind)
        for field in annotation.model_fields.values():
            yield from _sections(field.annotation)
        yield from _sections(get_type_hints(annotation).get("__pydantic_extra__"))


def check_keys(text: str, where: str) -> None:
    """Reject TOML that the parser takes quadratic time or too many nested calls for.

    Parameters
    ----------
    text : str
    where : str
        Origin of the text, for the message.

    Raises
    ------
    CaseError
    """
    found = _LONG_KEY.search(text)
    if found is not None:
        line = text.count("\n", 0, found.start()) + 1
        raise CaseError(f"{where}: line {line} has a key of more than {MOST_PARTS} parts")
    depth = 0
    for bracket in re.finditer(r"[\[\]{}]", _QUOTED.sub("", text)):
        depth += 1 if bracket[0] in "[{" else -1
        if depth > _DEEPEST:
            raise CaseError(f"{where}: is not valid TOML: brackets nested deeper than {_DEEPEST}")


def check_tables(tables: dict[str, Any]) -> None:
    """Reject tables that are too deep or too large, and integers beyond the range of floats.

    Raises
    ------
    CaseError
        At the first fault.
    """
    count = 0
    level: list[tuple[str, Any]] = [("", tables)]
    for depth in range(MOST_PARTS + 1):
        below = [pair for path, value in level for pair in _parts(path, value)]
        count += len(below)
        if count > MOST_VALUES:
            raise CaseError(f"the case has more than {MOST_VALUES} values, the limit")
        for path, value in below:
            if isinstance(value, int) and value.bit_length() > _WIDEST:
                raise CaseError(f"{path}: the integer has too many digits")
        level = [(path, value) for path, value in below if isinstance(value, dict | list | tuple)]
        if not level:
            return
        if depth == MOST_PARTS:
            raise CaseError(
                f"{level[0][0]}: tables or lists are nested too deeply; at most "
                f"{MOST_PARTS} levels are allowed"
            )


def _parts(path: str, value: Any):
    """Entries of a table or a list, with the path of each."""
    entries = value.items() if isinstance(value, dict) else enumerate(value)
    above = f"{path}." if path else ""
    for key, inner in entries:
        if isinstance(key, str) and len(key) > LONGEST_KEY:
            raise CaseError(
                f"{above}{quoted(key)}: the key has {len(key)} characters; at most "
                f"{LONGEST_KEY} are allowed"
            )
        yield f"{above}{key}", inner
