"""Console output of a study: medians, intervals, and the inputs that matter most."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from ..progress import PlainTable
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
