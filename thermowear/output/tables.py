"""The CSV files of a results folder."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from .quantities import HISTORY, INTERFACE, Quantity

_NUMBER = "{:.15g}"


def interface_name(time: float | None) -> str:
    """File name of the interface at an output time, or at the end."""
    return "interface.csv" if time is None else f"interface_{time:g}.csv"


def write_interface(path: Path, interface) -> None:
    """Write a row a contact point.

    Parameters
    ----------
    path : Path
    interface : thermowear.simulation.Interface
    """
    columns = [getattr(interface, name) for name in INTERFACE]
    _write(path, INTERFACE, zip(*columns, strict=True))


class HistoryWriter:
    """``history.csv``, a row a step; every row is on disk as soon as it is known."""

    def __init__(self, path: Path):
        self._path = path
        _write(path, HISTORY, [])

    def add(self, row) -> None:
        """Append a `thermowear.simulation.HistoryRow`."""
        with self._path.open("a", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerow(
                _NUMBER.format(getattr(row, name)) for name in HISTORY
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
