"""Console output of a study: medians, intervals, and the inputs that matter most."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rich.console import Console

from ...errors import CaseError
from ..files import read_object
from ..progress import PlainTable
from ..report import write_report
from ..report.contents import embedded
from ..report.figures import Figure, number, table_lines, verdict
from .folder import CASE
from .record import StudyRecord, read_study

_NAMED = 3
_LEAST = 0.02
"""Smallest share of an input that is named."""


def print_study(console: Console, folder: Path) -> None:
    """Print the main outputs of a study, one per line."""
    record = read_study(folder)
    if not record.outputs:
        return
    share = "total Sobol index" if record.indices else "share in the squared swings"
    heads = ("output", "median", "95 % interval", f"most influential inputs ({share})")
    table = PlainTable(*heads)
    for output in record.main:
        table.add_row(*_line(record, output))
    console.print(table)


def _line(record: StudyRecord, output: str) -> tuple[str, str, str, str]:
    quantity = record.quantity(output)
    low, median, high = (
        quantity.drawn(record.quantile(output, name)) for name in ("2.5%", "50%", "97.5%")
    )
    return (
        f"{quantity.label} [{quantity.unit}]",
        f"{median:.5g}",
        f"{low:.5g} … {high:.5g}",
        influences(record, output),
    )


def influences(record: StudyRecord, output: str) -> str:
    """Most influential inputs with their shares."""
    named = [pair for pair in record.influence(output)[:_NAMED] if pair[1] >= _LEAST]
    return ", ".join(f"{record.brief(name)} {part:.2f}" for name, part in named)


_CAPTIONS = {
    "distributions": "Histograms of the main outputs: median and 95 % interval.",
    "tornado": "Outputs with one input at a time at its 5 % and 95 % quantile, the others at their "
    "medians.",
    "sobol": "Shares of the inputs in the variance of the outputs, alone and with interactions; "
    "95 % intervals.",
    "bands": "Medians and 95 % bands of curves.",
}


def write_study_report(folder: Path) -> Path:
    """Write ``report.html`` of a study.

    Raises
    ------
    CaseError
        If the folder has no results of a study, or cannot be written.
    """
    try:
        record = read_study(folder)
        run = read_object(folder / "run.json") or {}
        text = (folder / CASE).read_text(encoding="utf-8")
        case = tomllib.loads(text)
    except (OSError, ValueError) as error:
        raise CaseError(f"{folder}: cannot be read: {error}") from None
    return write_report(folder, _contents(record, run, text, case))


def _contents(
    record: StudyRecord, run: dict[str, Any], text: str, case: dict[str, Any]
) -> dict[str, Any]:
    about = {key: value for key, value in run.items() if key != "study"}
    return {
        "title": str(case.get("title") or record.folder.absolute().name),
        "verdict": verdict(run, {}),
        "balances": [],
        "groups": _groups(record),
        "pictures": [
            picture
            for name, caption in _CAPTIONS.items()
            for picture in embedded(record.folder / f"{name}.png", caption)
        ],
        "drawable": bool(record.outputs),
        "tables": [],
        "case": table_lines(case, "case"),
        "case_text": text,
        "run": table_lines(about, "run"),
        "folder": record.folder,
    }


def _groups(record: StudyRecord) -> dict[str, list[Figure]]:
    groups = {"Median and 95 % interval": list(_intervals(record))}
    kind = "total Sobol index" if record.indices else "share in the squared swings"
    groups[f"Most influential inputs ({kind})"] = [
        Figure(record.quantity(output).label, influences(record, output), output)
        for output in record.main
    ]
    return {name: figures for name, figures in groups.items() if figures}


def _intervals(record: StudyRecord) -> Iterator[Figure]:
    for output in record.main:
        quantity = record.quantity(output)
        low, median, high = (
            number(float(quantity.drawn(record.quantile(output, name))))
            for name in ("2.5%", "50%", "97.5%")
        )
        source = f"{output}: quantiles.csv"
        yield Figure(quantity.label, f"{median} ({low} … {high}) {quantity.unit}", source)
