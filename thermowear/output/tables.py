"""Reading and writing of the CSV files of a results folder."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from .atomic_write import replacing
from .quantities import Quantity

_NUMBER = "{:.15g}"


def name_at(stem: str, time: float | None) -> str:
    """File name of a table at an output time, or at the end."""
    return f"{stem}.csv" if time is None else f"{stem}_{time:g}.csv"


def write_points(path: Path, table: dict[str, Quantity], points) -> None:
    """Write one row per contact point.

    Parameters
    ----------
    path : Path
    table : dict of str to Quantity
        `INTERFACE` or `FRICTION`.
    points : thermowear.simulation.InterfaceFields or FrictionInterface
    """
    columns = [getattr(points, name) for name in table]
    _write(path, table, zip(*columns, strict=True))


class RowWriter:
    """Writer of ``history.csv`` and similar tables, one row per step, written immediately.

    Parameters
    ----------
    path : Path
    table : dict of str to Quantity
    rows : iterable, optional
        Initial rows, such as `thermowear.simulation.HistoryRow` or `LoadRow`.
    """

    def __init__(self, path: Path, table: dict[str, Quantity], rows: Iterable = ()):
        self._path = path
        self._table = table
        _write(path, table, map(self._values, rows))

    def add(self, row) -> None:
        """Append a row; if the disk is full, no part of it is kept."""
        whole = self._path.stat().st_size
        try:
            with self._path.open("a", encoding="utf-8", newline="") as file:
                csv.writer(file, lineterminator="\n").writerow(_texts(self._values(row)))
        except OSError:
            os.truncate(self._path, whole)
            raise

    def _values(self, row) -> list[float]:
        return [getattr(row, name) for name in self._table]


def read(path: Path, table: dict[str, Quantity]) -> dict[str, np.ndarray]:
    """Read the columns of a CSV file by the names of its table, in SI.

    An incomplete last row is ignored.

    Raises
    ------
    ValueError
        If the file does not have the columns of the table.
    """
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(line for line in file if line.endswith("\n")))
    headers = [quantity.header for quantity in table.values()]
    if not rows or rows[0] != headers:
        raise ValueError(f"{path}: does not begin with the columns {','.join(headers)}")
    values = np.array([[float(cell) for cell in row] for row in rows[1:]])
    return dict(zip(table, values.reshape(-1, len(headers)).T, strict=True))


def _write(path: Path, table: dict[str, Quantity], rows: Iterable) -> None:
    with replacing(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(quantity.header for quantity in table.values())
        writer.writerows(map(_texts, rows))


def _texts(values: Iterable) -> list[str]:
    return [_NUMBER.format(value) for value in values]
