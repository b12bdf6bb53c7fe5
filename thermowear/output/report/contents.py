"""Contents of a report, read from the files of a results folder."""

from __future__ import annotations

import base64
import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...errors import CaseError
from ...results import TABLES
from ..names import PICTURES
from ..tables import read
from .columns import AT_TIMES, ShownTable, output_times, shown_table
from .figures import BalanceFigure, Figure, Verdict, balances, key_figures, verdict
from .unit_format import table_lines

_PNG = b"\x89PNG\r\n\x1a\n"


@dataclass(frozen=True)
class Picture:
    """Picture of a report, encoded as base64 text."""

    name: str
    caption: str
    data: str


@dataclass(frozen=True)
class ReportContents:
    """Contents of a report.

    Attributes
    ----------
    title : str
    verdict : Verdict
    balances : list of BalanceFigure
    groups : dict of str to list of Figure
    pictures : list of Picture
    drawable : bool
        True if there are results to draw pictures from.
    tables : list of ShownTable
    case : list of tuple of str
        Name and content of each table of the case.
    case_text : str
        Full text of ``case.resolved.toml``.
    run : list of tuple of str
        Record of the run: status, times, versions.
    folder : Path
    """

    title: str
    verdict: Verdict
    balances: list[BalanceFigure]
    groups: dict[str, list[Figure]]
    pictures: list[Picture]
    drawable: bool
    tables: list[ShownTable]
    case: list[tuple[str, str]]
    case_text: str
    run: list[tuple[str, str]]
    folder: Path


def read_contents(folder: Path) -> ReportContents:
    """Read a results folder, finished or not.

    Raises
    ------
    CaseError
        If the folder is not a results folder, or a file in it is invalid.
    """
    try:
        run = _object(folder / "run.json")
        versions = run.get("versions")
        if not isinstance(versions, dict) or "thermowear" not in versions:
            raise CaseError(
                f"{folder}: its run.json was not written by this program; not a results folder"
            )
        summary_file, case_file = folder / "summary.json", folder / "case.resolved.toml"
        summary = _object(summary_file) if summary_file.is_file() else {}
        text, case = _toml(case_file) if case_file.is_file() else ("", {})
        return ReportContents(
            title=str(summary.get("title") or case.get("title") or folder.absolute().name),
            verdict=verdict(run, summary),
            balances=balances(summary),
            groups=key_figures(summary),
            pictures=list(_pictures(folder)),
            drawable=(folder / "interface.csv").is_file(),
            tables=list(_tables(folder, summary)),
            case=table_lines(case, "case"),
            case_text=text,
            run=table_lines(run, "run"),
            folder=folder,
        )
    except (FileNotFoundError, NotADirectoryError):
        raise CaseError(f"{folder}: contains no run.json; not a results folder") from None
    except OSError as error:
        raise CaseError(f"{folder}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise CaseError(str(error)) from None


def _object(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_bytes())
    except ValueError as error:
        raise CaseError(f"{path}: is not valid JSON: {error}") from None
    if not isinstance(content, dict):
        raise CaseError(f"{path}: is not a JSON object")
    return content


def _toml(path: Path) -> tuple[str, dict[str, Any]]:
    """Read a TOML file as text and as tables."""
    try:
        text = path.read_text(encoding="utf-8")
        return text, tomllib.loads(text)
    except ValueError as error:
        raise CaseError(f"{path}: is not valid TOML: {error}") from None


def _pictures(folder: Path):
    for name, caption in PICTURES.items():
        path = folder / f"{name}.png"
        content = path.read_bytes() if path.is_file() else b""
        if content.startswith(_PNG):
            yield Picture(name, caption, base64.b64encode(content).decode("ascii"))


def _tables(folder: Path, summary: dict[str, Any]):
    times = output_times(folder, summary.get("time_s"))
    if times:
        caption = "Output times: extremes and totals over the contact"
        yield shown_table(caption, times, AT_TIMES, "the tables of each time")
    for table in sorted(TABLES.values(), key=lambda table: not table.grows):
        path = folder / f"{table.stem}.csv"
        if path.is_file():
            columns = read(path)
            yield shown_table(table.caption, columns, columns.quantities, path.name)
