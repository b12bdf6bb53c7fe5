"""What a report says, read from the files of a results folder."""

from __future__ import annotations

import base64
import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...errors import CaseError
from .columns import Table, output_times, read_columns, shown_table
from .figures import Balance, Figure, balances, key_figures
from .glance import table_lines
from .verdict import Verdict, verdict

CAPTIONS = {
    "bodies": "The bodies: von Mises stress, and temperature where there is heat.",
    "deformed": "The bodies as they deform, magnified.",
    "interface": "Along the contact: pressure, temperatures of a hot run, shape of the worn face.",
    "profile": "The worn shape.",
    "wear": "Pressure and worn depth along the contact at the output times and at the end.",
    "track": "Worn depths of both bodies along x, body 1 in the middle of its stroke.",
    "history": "Largest pressure and worn volume over time.",
    "heat": "Temperatures of both faces, friction power and largest pressure over time.",
    "friction": "Shear between the limits of friction, and slip, at the output times.",
    "loads": "Tangential force over displacement, and energy dissipated over time.",
    "cycles": "Largest wear depth and worn volume over the cycles.",
    "mode": "Disturbances of the pressure: what grows fastest, and what stays at which speed.",
}
TABLES = {
    "history": "History, a row a step",
    "heat": "Heat, a row a step",
    "cycles": "Cycles, a row a computed one",
    "loads": "History of loads, a row an increment",
    "interface": "Contact at the end",
    "profile": "Worn shape at the end",
    "friction": "Friction at the end",
    "track": "Track at the end",
    "mode": "Disturbances of the pressure",
}
_PNG = b"\x89PNG\r\n\x1a\n"


@dataclass(frozen=True)
class Picture:
    """A picture as text in base 64."""

    name: str
    caption: str
    data: str


@dataclass(frozen=True)
class Contents:
    """All that stands in a report.

    Attributes
    ----------
    title : str
    verdict : Verdict
    balances : list of Balance
    groups : dict of str to list of Figure
    pictures : list of Picture
    drawable : bool
        Whether there is something to draw pictures from.
    tables : list of Table
    case : list of tuple of str
        Name and content of each table of the case.
    case_text : str
        All of ``case.resolved.toml``.
    run : list of tuple of str
        How and with what it was computed.
    folder : Path
    """

    title: str
    verdict: Verdict
    balances: list[Balance]
    groups: dict[str, list[Figure]]
    pictures: list[Picture]
    drawable: bool
    tables: list[Table]
    case: list[tuple[str, str]]
    case_text: str
    run: list[tuple[str, str]]
    folder: Path


def read_contents(folder: Path) -> Contents:
    """Read a results folder, finished or not.

    Raises
    ------
    CaseError
        If it is no results folder, or a file in it is not what it should be.
    """
    try:
        run = _object(folder / "run.json")
        versions = run.get("versions")
        if not isinstance(versions, dict) or "thermowear" not in versions:
            raise CaseError(f"{folder}: its run.json is not of this program; not a results folder")
        summary_file, case_file = folder / "summary.json", folder / "case.resolved.toml"
        summary = _object(summary_file) if summary_file.is_file() else {}
        text, case = _toml(case_file) if case_file.is_file() else ("", {})
        return Contents(
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
        raise CaseError(f"{folder}: holds no run.json; not a results folder") from None
    except OSError as error:
        raise CaseError(f"{folder}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise CaseError(str(error)) from None


def _object(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_bytes())
    except ValueError as error:
        raise CaseError(f"{path}: is no JSON: {error}") from None
    if not isinstance(content, dict):
        raise CaseError(f"{path}: holds no table of keys")
    return content


def _toml(path: Path) -> tuple[str, dict[str, Any]]:
    """A TOML file as text and as tables."""
    try:
        text = path.read_text(encoding="utf-8")
        return text, tomllib.loads(text)
    except ValueError as error:
        raise CaseError(f"{path}: is no TOML: {error}") from None


def _pictures(folder: Path):
    for name, caption in CAPTIONS.items():
        path = folder / f"{name}.png"
        content = path.read_bytes() if path.is_file() else b""
        if content.startswith(_PNG):
            yield Picture(name, caption, base64.b64encode(content).decode("ascii"))


def _tables(folder: Path, summary: dict[str, Any]):
    times = output_times(folder, summary.get("time_s"))
    if times:
        caption = "Output times: largest values and sums over the contact"
        yield shown_table(caption, times, "the tables of each time")
    for stem, caption in TABLES.items():
        if (folder / f"{stem}.csv").is_file():
            yield shown_table(caption, read_columns(folder / f"{stem}.csv"), f"{stem}.csv")
