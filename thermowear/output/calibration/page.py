"""Report of a calibration: ``report.html``."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from ...errors import CaseError
from ...results.quantity import Quantity
from ..files import read_object
from ..report import write_report
from ..report.contents import ShownTable, embedded
from ..report.figures import NOTHING, Figure, number, table_lines, verdict
from .folder import CALIBRATED, PICTURES, RESOLVED, read_calibration

_MOST = 60
"""Largest number of observations in the table of the report."""


def write_calibration_report(folder: Path) -> Path:
    """Write ``report.html`` of a calibration.

    Raises
    ------
    CaseError
        If the folder contains no calibration, or cannot be written.
    """
    try:
        record, rows = read_calibration(folder)
        run = read_object(folder / "run.json") or {}
        text = (folder / RESOLVED).read_text(encoding="utf-8")
        case = tomllib.loads(text)
        calibrated = folder / CALIBRATED
        if calibrated.is_file():
            text = calibrated.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise CaseError(str(error)) from None
    pictures = [
        p for name, text_ in PICTURES.items() for p in embedded(folder / f"{name}.png", text_)
    ]
    contents: dict[str, Any] = {
        "title": f"Calibration: {case.get('title') or folder.absolute().name}",
        "verdict": verdict(run, {}) if run.get("status") != "done" else _verdict(record),
        "balances": [],
        "groups": _groups(record),
        "pictures": pictures,
        "drawable": True,
        "tables": [_parameters(record), _correlation(record), _observations(rows)],
        "case": table_lines(case, "case"),
        "case_text": text,
        "run": table_lines(run, "run"),
        "folder": folder,
    }
    return write_report(folder, contents)


def _verdict(record: dict[str, Any]) -> Figure:
    notes = record.get("notes") or []
    if notes:
        return Figure("status", "Finished; " + "; ".join(notes) + ".", mark="unsure")
    return Figure("status", "Finished: all parameters are determined by the data.", mark="good")


def _groups(record: dict[str, Any]) -> dict[str, list[Figure]]:
    level = f"{100 * record['confidence']:g} %"
    parameters = [
        Figure(
            name,
            f"{number(one['value'])} {one['unit']} ({level}: {_interval(one['interval'])})",
            one["key"] or "calibrate.set",
        )
        for name, one in record["parameters"].items()
    ]
    shown = {
        "reduced chi²": record.get("reduced_chi2"),
        "p-value": record.get("p_value"),
        "degrees of freedom": record.get("degrees_of_freedom"),
        "runs": record.get("runs"),
        "seconds": record.get("seconds"),
    }
    quality = [Figure(label, number(value)) for label, value in shown.items() if value is not None]
    groups = {"Parameters": parameters, "Quality of the fit": quality}
    if record.get("combinations"):
        groups["Combinations that the data determine"] = [
            Figure(one["text"], f"± {number(one['deviation'])}") for one in record["combinations"]
        ]
    return groups


def _interval(ends: list[float | None]) -> str:
    low, high = (NOTHING if end is None else number(end) for end in ends)
    return f"{low} … {high}"


def _head(label: str, unit: str = "") -> Quantity:
    return Quantity(label, label, unit, unit)


def _parameters(record: dict[str, Any]) -> ShownTable:
    level = f"{100 * record['confidence']:g} %"
    heads = ["parameter", "key", "value", "unit", f"lower, {level}", f"upper, {level}"]
    heads += ["standard error", "lower bound", "upper bound"]
    rows = []
    for name, one in record["parameters"].items():
        ends = [NOTHING if end is None else number(end) for end in one["interval"]]
        error = one["standard_error"]
        shown = NOTHING if error is None else number(error)
        if error is not None and one["scale"] == "log":
            shown = f"{100 * error:.3g} %"
        bounds = [number(one["lower"]), number(one["upper"])]
        first = [name, one["key"] or "calibrate.set", number(one["value"]), one["unit"]]
        rows.append([*first, *ends, shown, *bounds])
    return ShownTable("Parameters", "from calibration.json", [_head(h) for h in heads], rows)


def _correlation(record: dict[str, Any]) -> ShownTable:
    names = list(record["parameters"])
    rows = [
        [name, *(NOTHING if value is None else f"{value:.3f}" for value in row)]
        for name, row in zip(names, record["correlation"], strict=True)
    ]
    heads = [_head("parameter"), *(_head(name) for name in names)]
    return ShownTable("Correlation of the parameters", "from calibration.json", heads, rows)


def _observations(rows: list[dict[str, str]]) -> ShownTable:
    names = [name for name in rows[0] if any(_is_given(row[name]) for row in rows)]
    shown = rows[:: max(1, -(-len(rows) // _MOST))]
    note = f"{len(shown)} of {len(rows)} rows of observations.csv; SI units"
    cells = [[_cell(row[name]) for name in names] for row in shown]
    heads = [_head(name.replace("_", " ")) for name in names]
    return ShownTable("Observations", note, heads, cells)


def _is_given(text: str) -> bool:
    return text not in ("", "nan")


def _cell(text: str) -> str:
    try:
        return number(float(text))
    except ValueError:
        return text
