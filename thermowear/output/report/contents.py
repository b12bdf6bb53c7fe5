"""``report.html``: its contents, read from the files of a results folder, and its rendering."""

from __future__ import annotations

import base64
import json
import os
import re
import tomllib
from pathlib import Path
from typing import Any

from ...errors import CaseError
from ...results import TABLES
from ..files import PICTURES, is_report, write_text
from ..tables import read
from .columns import AT_TIMES, output_times, shown_table
from .figures import NOTHING, balances, key_figures, table_lines, verdict

_PNG = b"\x89PNG\r\n\x1a\n"
_UNPRINTABLE = re.compile("[^\t\n\x20-\x7e\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def write_report(folder: Path) -> Path:
    """Write ``report.html``, one file with embedded pictures and style.

    Parameters
    ----------
    folder : Path
        Results of a run, finished or not.

    Returns
    -------
    Path
        Path of the report.

    Raises
    ------
    CaseError
        If the folder has no results or a ``report.html`` of other origin, or cannot be written.
    """
    path = folder / "report.html"
    text = page(read_contents(folder))
    if os.path.lexists(path) and not is_report(path):
        raise CaseError(
            f"{path}: exists and is not a report of this program; move it away or rename it"
        )
    try:
        write_text(path, text)
    except OSError as error:
        raise CaseError(f"{path}: cannot be written: {error.strerror}") from None
    return path


def page(contents: dict[str, Any]) -> str:
    """Render the contents as HTML; all text is escaped."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader(__package__, "."),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_printable,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("report.html").render(report=contents)


def _printable(value: object) -> object:
    """Text without characters that are invalid in HTML; a dash for None."""
    if value is None:
        return NOTHING
    return _UNPRINTABLE.sub("\ufffd", value) if type(value) is str else value


def read_contents(folder: Path) -> dict[str, Any]:
    """Read the contents of a report from a results folder, of a run that finished or not.

    Returns
    -------
    dict
        Variables of the template, by the names used there.

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
        return {
            "title": str(summary.get("title") or case.get("title") or folder.absolute().name),
            "verdict": verdict(run, summary),
            "balances": balances(summary),
            "groups": key_figures(summary),
            "pictures": list(_pictures(folder)),
            "drawable": (folder / "interface.csv").is_file(),
            "tables": list(_tables(folder, summary)),
            "case": table_lines(case, "case"),
            "case_text": text,
            "run": table_lines(run, "run"),
            "folder": folder,
        }
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
            encoded = base64.b64encode(content).decode("ascii")
            yield {"name": name, "caption": caption, "data": encoded}


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
