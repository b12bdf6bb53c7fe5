"""Columns of numbers from CSV files whose header gives quantities and units."""

from __future__ import annotations

import csv
import difflib
import math
import re
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from ...user_files import read_text

LARGEST = 10_000_000
"""Largest size of a file [bytes]."""
MOST_ROWS = 5_000
"""Largest number of rows: each is a step boundary, and is written to the resolved case."""
_SHOWN = 40  # characters quoted from a cell
_HEAD = re.compile(r"([^\[\]()]+?)\s*(?:\[(?P<unit>[^\[\]]*)\]|\((?P<in_words>[^\[\]]*)\))?")
_SEPARATOR = re.compile(r"sep=(.)", re.IGNORECASE)
"""First line by which spreadsheets tell the separator."""
_MOST_NAMES = 12
"""Largest number of known columns that a message lists; of more, those of similar names."""
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)


@dataclass(frozen=True)
class Columns:
    """Table by columns.

    Attributes
    ----------
    name : str
        Name of the file.
    values : dict of str to list
        Values by key: quantities as text; numbers where the header has no unit.
    lines : list of int
        Line number of each row in the file, from 1.
    """

    name: str
    values: dict[str, list[str | float]]
    lines: list[int]


def column_names(path: Path) -> list[str]:
    """Names of the columns of a CSV file, without units.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    rows = _rows(path.name, _text(path))
    matches = [_HEAD.fullmatch(cell) for cell in (rows[0][1] if rows else [])]
    return [_name(match[1]) for match in matches if match is not None]


def read_columns(path: Path, known: dict[str, str], ordered: bool = True) -> Columns:
    """Read a CSV file: a header such as ``time [s], force [kN]``, then rows of numbers.

    Commas, semicolons or tabs separate the cells; numbers have a decimal point; units are in
    brackets or parentheses; empty lines and comments (``#``) are skipped, and columns of empty
    cells, as spreadsheets leave them at the end.

    Parameters
    ----------
    path : Path
    known : dict of str to str
        Allowed keys, each with an example of a suitable unit; empty for plain numbers. Words of a
        key may be separated by spaces.
    ordered : bool
        Times must increase.

    Raises
    ------
    ValueError
        With file and line, if the file is no such table.
    """
    name = path.name
    rows = _rows(name, _text(path))
    if not rows:
        raise ValueError(f"{name} is empty; needs a header with columns of: {_listed(known)}")
    heads = _heads(name, *rows[0], known)
    body = rows[1:]
    if not body:
        raise ValueError(f"{name} has a header but no rows of numbers")
    if len(body) > MOST_ROWS:
        raise ValueError(f"{name} has {len(body)} rows; at most {MOST_ROWS} are allowed")
    table = [_numbers(name, line, cells, list(heads)) for line, cells in body]
    if ordered and "time" in heads:
        _increasing(name, [row[list(heads).index("time")] for row in table], body)
    values: dict[str, list[str | float]] = {
        key: [f"{x!r} {unit}" if unit else x for x in column]
        for (key, unit), column in zip(heads.items(), zip(*table, strict=True), strict=True)
    }
    return Columns(name, values, [line for line, _ in body])


def _text(path: Path) -> str:
    try:
        return read_text(path, LARGEST)
    except OSError as error:
        raise ValueError(f"{path} cannot be read: {error.strerror}") from None
    except ValueError as error:  # not in UTF-8, or an invalid file name
        raise ValueError(f"{path} {error}; save it as CSV in UTF-8") from None


def _rows(name: str, text: str) -> list[tuple[int, list[str]]]:
    """Rows with their line numbers, without comments and empty lines."""
    lines = [
        (number, line)
        for number, line in enumerate(re.split("\r\n|\r|\n", text), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        return []
    told = _SEPARATOR.fullmatch(lines[0][1].strip("\ufeff "))
    lines = lines[1:] if told else lines
    if not lines:
        return []
    separator = told[1] if told else next((mark for mark in ";\t" if mark in lines[0][1]), ",")
    options: dict = {"delimiter": separator, "skipinitialspace": separator != " ", "strict": True}
    cells = csv.reader((line for _, line in lines), **options)
    found: list[tuple[int, list[str]]] = []
    for number, _ in lines:
        try:
            found.append((number, [cell.strip() for cell in next(cells)]))
        except (csv.Error, StopIteration) as error:  # a quotation mark may have joined lines
            if isinstance(error, csv.Error) and "end of data" not in str(error):
                raise ValueError(f"{name}, line {number}: {error}") from None
            raise ValueError(f"{name}: a quotation mark is not closed on its line") from None
    while all(len(row) > 1 and not row[-1] for _, row in found):
        found = [(number, row[:-1]) for number, row in found]
    return found


def _listed(known: dict[str, str], name: str = "") -> str:
    """Known columns with their units, or those of a similar name if there are many."""
    if len(known) > _MOST_NAMES:
        close = difflib.get_close_matches(name, known, _MOST_NAMES // 2, cutoff=0.5)
        names = dict.fromkeys([*close, *list(known)[: _MOST_NAMES // 2]])
        known = {key: known[key] for key in names}
        return f"{_listed(known)}, and other names of docs/reference/results.md"
    return ", ".join(f"{key} [{unit}]" if unit else key for key, unit in known.items())


def _heads(name: str, line: int, cells: list[str], known: dict[str, str]) -> dict[str, str]:
    """Units by key, in the order of the columns; empty for plain numbers."""
    where, heads = f"{name}, line {line}", {}
    for cell in cells:
        match = _HEAD.fullmatch(cell)
        key = _name(match[1]) if match else ""
        if match is None or key not in known:
            raise ValueError(
                f"{where}: found the column {_shown(cell)}; known: {_listed(known, key)}; lines "
                "that are neither header nor numbers begin with #"
            )
        if key in heads:
            raise ValueError(f"{where}: the column {key} is given twice")
        unit = (match["unit"] or match["in_words"] or "").strip()
        unit = "" if unit in ("-", "1") else unit
        if known[key] and not unit:
            raise ValueError(f"{where}: {key}: unit missing; write {key} [{known[key]}]")
        if unit and not known[key]:
            raise ValueError(
                f"{where}: {key}: found the unit {_shown(unit)}; must be a plain number without "
                "unit"
            )
        heads[key] = unit
    return heads


def _name(text: str) -> str:
    """Key from the words of a header."""
    return "_".join(text.lower().split())


def _numbers(name: str, line: int, cells: list[str], keys: list[str]) -> list[float]:
    where = f"{name}, line {line}"
    if len(cells) != len(keys):
        raise ValueError(f"{where}: has {len(cells)} cells for {len(keys)} columns")
    for key, cell in zip(keys, cells, strict=True):
        if not _NUMBER.fullmatch(cell) or not math.isfinite(float(cell)):
            point = " with a decimal point" if "," in cell else ""
            raise ValueError(
                f"{where}: {key}: found {_shown(cell)}; must be a finite number{point}"
            )
    return [float(cell) for cell in cells]


def _increasing(name: str, times: list[float], body: list[tuple[int, list[str]]]) -> None:
    for (before, after), (line, _) in zip(pairwise(times), body[1:], strict=True):
        if not after > before:
            raise ValueError(f"{name}, line {line}: time: found {after:g}; must increase")


def _shown(cell: str) -> str:
    return repr(cell if len(cell) <= _SHOWN else f"{cell[:_SHOWN]}…")
