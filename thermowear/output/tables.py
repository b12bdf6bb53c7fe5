"""The CSV files of a results folder."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from .quantities import Quantity

_NUMBER = "{:.15g}"


def name_at(stem: str, time: float | None) -> str:
    """File name of a table at an output time, or at the end."""
    return f"{stem}.csv" if time is None else f"{stem}_{time:g}.csv"


def write_points(path: Path, table: dict[str, Quantity], points) -> None:
    """Write a row a contact point.

    Parameters
    ----------
    path : Path
    table : dict of str to Quantity
        `INTERFACE` or `FRICTION`.
    points : thermowear.simulation.Interface or FrictionInterface
    """
    columns = [getattr(points, name) for name in table]
    _write(path, table, zip(*columns, strict=True))


class RowWriter:
    """``history.csv`` or ``loads.csv``, a row a step, on disk as soon as it is known."""

    def __init__(self, path: Path, table: dict[str, Quantity]):
        self._path = path
        self._table = table
        _write(path, table, [])

    def add(self, row) -> None:
        """Append a `thermowear.simulation.HistoryRow` or `LoadRow`."""
        with self._path.open("a", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerow(
                _NUMBER.format(getattr(row, name)) for name in self._table
            )


def read(path: Path, table: dict[str, Quantity]) -> dict[str, np.ndarray]:
    """Columns of a CSV file by the names of its table, in SI.

    Raises
    ------
    ValueError
        If the file is not such a table.
    """
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    headers = [quantity.header for quantity in table.values()]
    if not rows or rows[0] != headers:
        raise ValueError(f"{path}: does not begin with the columns {','.join(headers)}")
    values = np.array([[float(cell) for cell in row] for row in rows[1:]])
    return dict(zip(table, values.reshape(-1, len(headers)).T, strict=True))


def _write(path: Path, table: dict[str, Quantity], rows: Iterable) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(quantity.header for quantity in table.values())
        writer.writerows([_NUMBER.format(value) for value in row] for row in rows)
