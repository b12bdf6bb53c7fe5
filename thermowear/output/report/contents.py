"""Tables of a report: few rows, in the units of plots, without rounding errors.

Tables have few rows, in the units of plots.
"""

from __future__ import annotations

import base64
import json
import os
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import CaseError
from ...results.quantity import TABLES, Quantity, from_key
from ...results.summary_keys import of_key
from ..files import PICTURES, between, contacts_of, is_report, name_at, picture, states, write_text
from ..tables import TableColumns, read
from .figures import NOISE, NOTHING, balances, key_figures, number, table_lines, verdict

_ROWS = 20


def table_of(columns: TableColumns, caption: str, source: str) -> ShownTable:
    """Table of a file; of the points of a face in space only their number."""
    shown = _left_out if _of_a_surface(columns) else shown_table
    return shown(caption, columns, columns.quantities, source)


def _of_a_surface(columns: TableColumns) -> bool:
    """Test for points of a face in space, which have no order that a few rows could show."""
    return "s" in columns and bool(np.isnan(columns["s"]).all())


def _left_out(caption: str, columns: TableColumns, _quantities, source: str) -> ShownTable:
    """Table without rows."""
    count = len(next(iter(columns.values()), ()))
    return ShownTable(caption, f"{number(count)} points in {source}, not shown here", [], [])


@dataclass(frozen=True)
class ShownTable:
    """Table of a report as text.

    Attributes
    ----------
    caption, note : str
    heads : list of Quantity
    rows : list of list of str
    """

    caption: str
    note: str
    heads: list[Quantity]
    rows: list[list[str]]


def shown_table(
    caption: str,
    columns: Mapping[str, np.ndarray],
    quantities: Mapping[str, Quantity],
    source: str,
) -> ShownTable:
    """Table of at most twenty rows, including first and last, of the columns with content."""
    total = len(next(iter(columns.values()), ()))
    chosen = np.unique(np.linspace(0, total - 1, min(total, _ROWS)).round().astype(int))
    columns = _without_noise(columns, quantities)
    full = {name: v for name, v in columns.items() if (np.isfinite(v) & (v != 0)).any()}
    heads = [quantities[name] for name in full]
    drawn = [head.drawn(values[chosen]) for head, values in zip(heads, full.values(), strict=True)]
    rows = [[number(float(value)) for value in row] for row in zip(*drawn, strict=True)]
    note = f"{len(chosen)} of {total} rows of {source}" if len(chosen) < total else f"from {source}"
    if len(full) < len(columns):
        note += "; empty columns are left out"
    return ShownTable(caption, note, heads, rows)


def _without_noise(
    columns: Mapping[str, np.ndarray], quantities: Mapping[str, Quantity]
) -> dict[str, np.ndarray]:
    """Columns with zeros for rounding errors, compared with all columns in the same SI unit."""
    sizes: dict[str, float] = {}
    for name, values in columns.items():
        size = np.abs(values[np.isfinite(values)]).max(initial=0.0)
        sizes[quantities[name].si] = max(sizes.get(quantities[name].si, 0.0), float(size))
    sizes[""] = min(sizes.get("", 0.0), 1.0)  # numbers without a unit have no common size
    limits = {name: NOISE * sizes[quantities[name].si] for name in columns}
    return {name: np.where(np.abs(v) < limits[name], 0.0, v) for name, v in columns.items()}


_WIDE = 1300  # pixels from which a picture gets a whole row
_PNG = b"\x89PNG\r\n\x1a\n"
_UNPRINTABLE = re.compile("[^\t\n\x20-\x7e\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def write_report(folder: Path, contents: dict[str, Any] | None = None) -> Path:
    """Write ``report.html``, one file with embedded pictures and style.

    Parameters
    ----------
    folder : Path
        Results of a run, finished or not.
    contents : dict, optional
        Variables of the template, by default those of a run (`read_contents`).

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
    text = page(contents or read_contents(folder))
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
            "case": table_lines({k: case[k] for k in case if k != "title"}, "case"),
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
    contacts = dict.fromkeys(["", *contacts_of(folder)])
    for (name, caption), contact in product(PICTURES.items(), contacts):
        where = f"Contact {contact}: {caption[0].lower()}{caption[1:]}" if contact else caption
        yield from embedded(folder / picture(name, contact), where)


def embedded(path: Path, caption: str):
    """Yield a picture of a report, unless there is none."""
    content = path.read_bytes() if path.is_file() else b""
    if content.startswith(_PNG):
        encoded = base64.b64encode(content).decode("ascii")
        wide = int.from_bytes(content[16:20]) > _WIDE
        yield {"name": path.stem, "caption": caption, "data": encoded, "wide": wide}


def _tables(folder: Path, summary: dict[str, Any]):
    times = output_times(folder, summary.get("time_s"))
    if times:
        caption = "Output times: extremes and totals over the contact"
        named = {header: q.of_bodies(between(summary)) for header, q in AT_TIMES.items()}
        yield shown_table(caption, times, named, "the tables of each time")
    for table in sorted(TABLES.values(), key=lambda table: not table.grows):
        path = folder / f"{table.stem}.csv"
        if path.is_file():
            columns = read(path)
            yield table_of(columns, table.caption, path.name)


def output_times(folder: Path, end: float | None) -> dict[str, np.ndarray]:
    """Extremes and totals at the output times by header, one row per time; empty without them.

    Parameters
    ----------
    folder : Path
    end : float or None
        Final time, to which the tables without a time in their names belong [s].
    """
    found: dict[float, dict[str, float]] = {}
    for stem in _TOTALS:
        for time, path in states(folder, stem).items():
            found.setdefault(time, {}).update(_totals(stem, read(path)))
    if not found:
        return {}
    for stem in _TOTALS:
        path = folder / name_at(stem, None)
        if end is not None and path.is_file():
            found.setdefault(end, {}).update(_totals(stem, read(path)))
    times = sorted(found)
    headers = dict.fromkeys(header for time in times for header in found[time])
    rows = {h: np.array([found[time].get(h, np.nan) for time in times]) for h in headers}
    return {"time_s": np.array(times)} | rows


def _totals(stem: str, points: TableColumns) -> dict[str, float]:
    """Extremes over the contact points, and integrals over the contact, by header."""
    if "weight" not in points or not points["weight"].size:
        return {}
    return {
        quantity.header: float(reduce(points[name], points["weight"]))
        for quantity, name, reduce in _TOTALS[stem]
        if name in points
    }


_interface, _history, _cycles, _loads = (
    TABLES[stem].columns for stem in ("interface", "history", "cycles", "loads")
)
_TOTALS = {
    "interface": (
        (_history["max_pressure"], "pressure", lambda p, w: p.max()),
        (_history["contact_area"], "pressure", lambda p, w: w[p > 0].sum()),
        (of_key("shape_range_m"), "shape", lambda h, w: np.ptp(h)),
        (_cycles["max_wear_1"], "wear_1", lambda depth, w: depth.max()),
        (_cycles["max_wear_2"], "wear_2", lambda depth, w: depth.max()),
        (_history["wear_volume_1"], "wear_1", lambda depth, w: w @ depth),
        (_history["wear_volume_2"], "wear_2", lambda depth, w: w @ depth),
        (_interface["temperature_1"], "temperature_1", lambda T, w: T.max()),
        (_interface["temperature_2"], "temperature_2", lambda T, w: T.max()),
    ),
    "friction": (
        (_loads["stick_area"], "status", lambda status, w: w[status == 1].sum()),
        (from_key("max_shear_Pa", "largest shear", "MPa"), "shear", lambda t, w: np.abs(t).max()),
        (from_key("max_slip_m", "largest slip", "µm"), "slip", lambda s, w: np.abs(s).max()),
        (_cycles["dissipated"], "dissipated", lambda energy, w: w @ energy),
    ),
}
"""Extremes and totals of each table: quantity, column, and its reduction with the area weights."""

AT_TIMES = {
    quantity.header: quantity
    for quantity in (_history["time"], *(q for rows in _TOTALS.values() for q, _, _ in rows))
}
"""Quantities of the table of output times by header."""
