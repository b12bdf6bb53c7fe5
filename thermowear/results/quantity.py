"""Quantities with name, label and units; tables declare each of them once, at its field::

    @table("film", "Film at the end", "one row per contact point")
    class Film:
        thickness: np.ndarray = column("film thickness", "m", "µm")

writes ``film.csv`` with the column ``thickness_m``, drawn in µm.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import Any, TypeVar, dataclass_transform

import numpy as np

from ..serialise import serialisable_row
from .units import key, multiple, scale_of, split_key

Kind = TypeVar("Kind")


@dataclass(frozen=True)
class Quantity:
    """Column of a table or number of the summary.

    Attributes
    ----------
    header : str
        Name in files, with the SI unit.
    label : str
        Label for people, without unit.
    si : str
        SI unit; empty for plain numbers and for texts.
    unit : str
        Unit of plots and tables, "1" for plain numbers.
    meaning : str
        Definition, sign and reference, where the label does not tell.
    """

    header: str
    label: str
    si: str
    unit: str
    meaning: str = ""

    @property
    def axis(self) -> str:
        """Axis label."""
        return f"{self.label} [{self.unit}]"

    @property
    def wrapped(self) -> str:
        """Axis label in two lines."""
        return f"{self.label}\n[{self.unit}]"

    @property
    def of_both(self) -> Quantity:
        """Quantity of both bodies in one plot: the label without the number of the body."""
        return replace(self, label=re.sub(", body [12]$", "", self.label))

    def drawn(self, values):
        """Convert SI values to the unit of plots."""
        scale, offset = scale_of(self.unit, self.si)
        return scale * values + offset

    def shown_in(self, unit: str) -> Quantity:
        """Quantity with another unit of plots."""
        return replace(self, unit=unit)


def from_key(header: str, label: str = "", unit: str = "", meaning: str = "") -> Quantity:
    """Quantity from its name in files, which tells its SI unit and by default its label."""
    name, si = split_key(header)
    return Quantity(header, label or name, si, unit or si or "1", meaning)


def unknown(header: str, values: np.ndarray) -> Quantity:
    """Quantity of a column that no table declares, in a unit that suits its size."""
    size = np.abs(values[np.isfinite(values)]).max(initial=0.0)
    return from_key(header, unit=multiple(split_key(header)[1], float(size))[0])


@dataclass(frozen=True)
class Table:
    """Table of the results folder.

    Attributes
    ----------
    stem : str
        Name of its file without ``.csv`` and time.
    caption : str
        Heading in the report.
    content : str
        Description for the reference.
    columns : dict of str to Quantity
        Columns by the names of the fields.
    at_times : bool
        True if it is written at the output times, too.
    grows : bool
        True if rows are appended during a run.
    """

    stem: str
    caption: str
    content: str
    columns: dict[str, Quantity]
    at_times: bool = False
    grows: bool = False

    def values(self, source) -> list:
        """Columns of points, or cells of a row, in the order of the file."""
        return [getattr(source, name) for name in self.columns]

    def arrays(self, source) -> dict[str, np.ndarray]:
        """Columns of points, or of a list of rows, by their headers."""
        is_rows = isinstance(source, list)
        columns = zip(*map(self.values, source), strict=True) if is_rows else self.values(source)
        headers = (quantity.header for quantity in self.columns.values())
        return dict(zip(headers, map(np.asarray, columns), strict=True))


TABLES: dict[str, Table] = {}
"""All tables by the stems of their files."""


def column(label: str, si: str = "", unit: str = "", meaning: str = "", header: str = "") -> Any:
    """Field of a table that declares a quantity.

    Parameters
    ----------
    label : str
    si : str
        SI unit, which becomes part of the header.
    unit : str
        Unit of plots, the SI unit by default.
    meaning : str
    header : str
        Name in files if it differs from the name of the field.
    """
    return field(metadata={"quantity": Quantity(header, label, si, unit or si or "1", meaning)})


def as_in(kind: type) -> Any:
    """Field of a table with the quantity of the same field of another table."""
    return field(metadata={"quantity": table_of(kind).columns})


def table_of(source: Any) -> Table:
    """Table of a class, of points, of a row, or of a list of rows."""
    return (source[0] if isinstance(source, list) else source).__table__


@dataclass_transform(field_specifiers=(column, as_in), frozen_default=True)
def table(
    stem: str, caption: str, content: str, *, at_times: bool = False, grows: bool = False
) -> Callable[[type[Kind]], type[Kind]]:
    """Decorator that makes a class a frozen dataclass and a table of the results folder."""

    def register(kind: type[Kind]) -> type[Kind]:
        made: Any = dataclass(frozen=True)(kind)
        made.__table__ = Table(stem, caption, content, declared(made), at_times, grows)
        TABLES[stem] = made.__table__
        return serialisable_row(made) if grows else made

    return register


def declared(kind: type) -> dict[str, Quantity]:
    """Quantities that the fields of a dataclass declare, by name."""
    found = {}
    for own in fields(kind):
        given = own.metadata.get("quantity")
        if isinstance(given, dict):  # of another table
            found[own.name] = given[own.name]
        elif given is not None:
            header = given.header or key(own.name, given.si)
            found[own.name] = replace(given, header=header)
    return found
