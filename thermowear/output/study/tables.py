"""Tables of a study: quantiles, Sobol indices, swings and bands; written and read back."""

from __future__ import annotations

import csv
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

import numpy as np

from ...inference import SampleQuantiles, SobolIndices, Swings
from ..tables import write_csv

QUANTILES, SOBOL, TORNADO, BANDS = "quantiles.csv", "sobol.csv", "tornado.csv", "bands_"
COLUMNS = {
    QUANTILES: ("output", "2.5%", "50%", "97.5%"),
    TORNADO: ("output", "input", "output_at_medians", "output_at_low", "output_at_high"),
    SOBOL: (
        *("output", "input", "first_order", "first_order_lower", "first_order_upper"),
        *("total", "total_lower", "total_upper"),
    ),
    "study.csv": ("status", "part"),
}
"""Columns that pictures and the report need, by table."""
SAMPLE = ("sample", "A", "B")
"""Parts of the design that are an independent sample of all inputs."""


def write_quantiles(folder: Path, outputs: Sequence[str], found: SampleQuantiles) -> None:
    """Write ``quantiles.csv``, one row per number of the summary that varies."""
    headers = ["output", "mean", "deviation", *(f"{100 * level:g}%" for level in found.levels)]
    rows = zip(
        *(outputs, found.mean, found.deviation, *found.values, found.counts, found.failed),
        strict=True,
    )
    write_csv(folder / QUANTILES, [*headers, "count", "failed"], rows)


def write_sobol(
    folder: Path, outputs: Sequence[str], inputs: Sequence[str], found: SobolIndices
) -> None:
    """Write ``sobol.csv``, one row per output and input."""
    headers = ["output", "input", "first_order", "first_order_lower", "first_order_upper"]
    headers += ["total", "total_lower", "total_upper", "rows", "rows_dropped"]
    rows = [
        [
            *(output, name, found.first[i, k], *found.first_interval[:, i, k]),
            *(found.total[i, k], *found.total_interval[:, i, k], found.rows[k], found.dropped[k]),
        ]
        for k, output in enumerate(outputs)
        for i, name in enumerate(inputs)
    ]
    write_csv(folder / SOBOL, headers, rows)


def write_tornado(
    folder: Path,
    outputs: Sequence[str],
    headers: Sequence[str],
    lows: Sequence[float],
    highs: Sequence[float],
    found: Swings,
) -> None:
    """Write ``tornado.csv``, one row per output and input, the inputs in SI by their headers."""
    names = ["output", "input", "input_low", "input_high"]
    rows = [
        [output, name, low, high, found.base[k], found.low[i, k], found.high[i, k]]
        for k, output in enumerate(outputs)
        for i, (name, low, high) in enumerate(zip(headers, lows, highs, strict=True))
    ]
    names += ["output_at_medians", "output_at_low", "output_at_high"]
    write_csv(folder / TORNADO, names, rows)


def write_bands(folder: Path, found: Mapping[str, Mapping[str, np.ndarray]]) -> None:
    """Write ``bands_history.csv`` and ``bands_interface.csv``, those of contacts by their names."""
    for stem, columns in found.items():
        rows = zip(*columns.values(), strict=True)
        write_csv(folder / bands_file(stem), list(columns), rows)


def bands_file(stem: str) -> str:
    """Name of a table of bands."""
    return f"{BANDS}{stem}.csv"


def read_cells(path: Path, columns: Collection[str] = ()) -> list[dict[str, str]]:
    """Rows of a table as text; empty if it was not written.

    Raises
    ------
    ValueError
        If rows are incomplete, any of some columns is missing, or the file is no text.
    """
    if not path.is_file():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    if any(None in row or None in row.values() for row in rows):
        raise ValueError(f"{path}: has rows that are not as long as its header")
    missing = [name for name in columns if rows and name not in rows[0]]
    if missing:
        raise ValueError(f"{path}: has no column {missing[0]}")
    return rows


def read_columns(path: Path) -> dict[str, np.ndarray]:
    """Columns of a table of numbers by header.

    Raises
    ------
    ValueError
        If the file is no such table.
    """
    rows = read_cells(path)
    if not rows:
        raise ValueError(f"{path}: has no rows")
    try:
        return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    except ValueError:
        raise ValueError(f"{path}: is not a table of numbers with headers") from None
