"""Reading and writing of the CSV files of a results folder."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Sequence
from functools import cached_property
from pathlib import Path

import numpy as np

from ..results.quantity import TABLES, Quantity, Table, table_of, unknown
from .files import atomic_write, bodies_of, model_of, table_file

_NUMBER = "{:.15g}"


class MissingColumnError(ValueError):
    """A file, such as one of another version of the program, lacks a column."""


class TableColumns(dict[str, np.ndarray]):
    """Columns of a file in SI, by the names of its fields; unknown ones by header.

    Parameters
    ----------
    path : Path
    columns : dict of str to ndarray
        Columns by header.
    """

    def __init__(self, path: Path, columns: dict[str, np.ndarray]):
        self._path = path
        table = TABLES.get(table_file(path.name).stem)
        self._known = {} if table is None else table.columns
        names = {quantity.header: name for name, quantity in self._known.items()}
        super().__init__((names.get(header, header), column) for header, column in columns.items())

    def __missing__(self, name: str) -> np.ndarray:
        raise MissingColumnError(f"{self._path.name} has no column {self._header(name)}")

    @cached_property
    def quantities(self) -> dict[str, Quantity]:
        """Quantities of the columns, labelled for the kinematic model and the bodies of the run."""
        others = {name: unknown(name, self[name]) for name in self if name not in self._known}
        folder, contact = self._path.parent, table_file(self._path.name).contact
        model, bodies = model_of(folder), bodies_of(folder, contact)
        every = self._known | others
        return {name: q.in_model(model).of_bodies(bodies) for name, q in every.items()}

    def drawn(self, name: str) -> np.ndarray:
        """Column in the unit of plots."""
        return self.quantities[name].drawn(self[name])

    @property
    def is_ours(self) -> bool:
        """True if the program declares any of the columns, or no table of that name."""
        return not self._known or not self._known.keys().isdisjoint(self)

    def rows(self, chosen: np.ndarray | slice) -> TableColumns:
        """Columns of some of the rows, chosen by a mask or a slice."""
        return TableColumns(self._path, {self._header(name): v[chosen] for name, v in self.items()})

    def _header(self, name: str) -> str:
        return self._known[name].header if name in self._known else name


def read(path: Path) -> TableColumns:
    """Read a CSV file of any version of the program; an incomplete last row is ignored.

    Raises
    ------
    ValueError
        If the file is not a table of numbers, or one of another program.
    """
    try:
        text = path.read_text(encoding="utf-8")
        lines = text[: text.rfind("\n") + 1].splitlines()
        (head,), rows = csv.reader(lines[:1]), lines[1:]
        cells = np.loadtxt(rows, delimiter=",", comments=None, ndmin=2) if rows else np.zeros(0)
        columns = cells.reshape(len(rows), len(head)).T
        found = TableColumns(path, dict(zip(head, columns, strict=True)))
    except ValueError:
        raise ValueError(f"{path}: is not a table of numbers with headers") from None
    if not found.is_ours:
        raise ValueError(f"{path}: has none of the columns that this program writes")
    return found


def write_points(path: Path, points) -> None:
    """Write points, such as `thermowear.results.InterfaceFields`, one per row.

    Optional columns without values are left out.
    """
    table = table_of(points).given(points)
    _write_table(path, table, zip(*table.values(points), strict=True))


class RowWriter:
    """Writer of ``history.csv`` and similar tables, one row per step, written immediately.

    Parameters
    ----------
    folder : Path
    table : Table
    rows : iterable, optional
        Initial rows, such as `thermowear.results.HistoryRow`.
    """

    def __init__(self, folder: Path, table: Table, rows: Iterable = ()):
        self._path = folder / f"{table.stem}.csv"
        self._table = table
        _write_table(self._path, table, map(table.values, rows))

    def add(self, row) -> None:
        """Append a row; if the disk is full, no part of it is kept."""
        whole = self._path.stat().st_size
        try:
            with self._path.open("a", encoding="utf-8", newline="") as file:
                csv.writer(file, lineterminator="\n").writerow(_texts(self._table.values(row)))
        except OSError:
            os.truncate(self._path, whole)
            raise


def _write_table(path: Path, table: Table, rows: Iterable) -> None:
    write_csv(path, [quantity.header for quantity in table.columns.values()], rows)


def write_csv(path: Path, headers: Sequence[str], rows: Iterable) -> None:
    """Write a CSV file of numbers and words."""
    with atomic_write(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headers)
        writer.writerows(map(_texts, rows))


def _texts(values: Iterable) -> list[str]:
    return [v if isinstance(v, str) else _NUMBER.format(v) for v in values]
