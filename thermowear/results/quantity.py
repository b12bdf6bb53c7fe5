"""Quantities with name, label and units; tables declare each of them once, at its field::

    @table("film", "Film at the end", "one row per contact point")
    class Film:
        thickness: np.ndarray = column("film thickness", "m", "µm")

writes ``film.csv`` with the column ``thickness_m``, drawn in µm. Headers contain SI units, pictures
and reports engineering units.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any, TypeVar, dataclass_transform

import numpy as np

from ..serialise import serialisable_row

Kind = TypeVar("Kind")

_MULTIPLES: dict[str, tuple[tuple[float, str, float], ...]] = {
    "Pa": ((1e10, "GPa", 1e-9), (0.0, "MPa", 1e-6)),
    "N": ((1e3, "kN", 1e-3), (0.0, "N", 1.0)),
    "N m": ((1e3, "kN m", 1e-3), (0.0, "N m", 1.0)),
    "m": ((1e-3, "mm", 1e3), (0.0, "µm", 1e6)),
    "m²": ((0.0, "mm²", 1e6),),
    "m³": ((0.0, "mm³", 1e9),),
    "m/s": ((1.0, "m/s", 1.0), (1e-3, "mm/s", 1e3), (1e-6, "µm/s", 1e6), (0.0, "nm/s", 1e9)),
    "W": ((1e3, "kW", 1e-3), (0.0, "W", 1.0)),
    "W/m²": ((1e3, "kW/m²", 1e-3), (0.0, "W/m²", 1.0)),
    "J": ((1e3, "kJ", 1e-3), (1.0, "J", 1.0), (1e-3, "mJ", 1e3), (0.0, "µJ", 1e6)),
    "kg": ((1.0, "kg", 1.0), (1e-3, "g", 1e3), (0.0, "mg", 1e6)),
    "rad": ((1.0, "rad", 1.0), (1e-3, "mrad", 1e3), (0.0, "µrad", 1e6)),
    "rad/s": ((1e-3, "rad/s", 1.0), (0.0, "nrad/s", 1e9)),
}
"""Engineering units by SI unit: smallest size [SI], unit, and scale from the SI unit."""

_IN_KEYS = {
    **{unit: unit for unit in ("Pa", "N", "m", "s", "K", "W", "J", "rad", "Hz", "kg")},
    **{"Nm": "N m", "m2": "m²", "m3": "m³"},
}
"""SI units by their spelling in the keys of results."""
_SPELLED = {unit: spelling for spelling, unit in _IN_KEYS.items()}
_AXISYMMETRIC = {"x": "r", "y": "z"}
_OF_A_BODY = re.compile(r"_[12](_|$)")


def key(name: str, si: str) -> str:
    """Key of a quantity: its name and its SI unit, such as ``wear_rate_1_m_per_s``."""
    above, _, below = si.partition("/")
    words = [name, _SPELLED.get(above, ""), *(["per", _SPELLED[below]] if below else [])]
    return "_".join(filter(None, words))


def split_key(key: str) -> tuple[str, str]:
    """Name and SI unit of a key such as ``wear_rate_1_m_per_s``: ``wear rate 1`` and ``m/s``."""
    *words, last = key.split("_")
    unit = _IN_KEYS.get(last, "")
    if unit and len(words) >= 2 and words[-1] == "per":
        above = _IN_KEYS.get(words[-2], "1")
        words, unit = words[: -1 if above == "1" else -2], f"{above}/{unit}"
    if not unit or not words:
        return key.replace("_", " "), ""
    return " ".join(words), unit


def multiple(si: str, size: float) -> tuple[str, float]:
    """Engineering unit for numbers up to a size [SI], and its scale from the SI unit."""
    for least, unit, scale in _MULTIPLES.get(si, ((0.0, si, 1.0),)):
        if abs(size) >= least:
            return unit, scale
    return si, 1.0  # the size is not a number


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
    optional : bool
        True for a column of points that is left out where it has no values.
    """

    header: str
    label: str
    si: str
    unit: str
    meaning: str = ""
    optional: bool = False

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
        """Quantity of both bodies in one plot: the label without the body."""
        return replace(self, label=self.label.rpartition(", ")[0]) if self.body else self

    @property
    def body(self) -> str:
        """Body that a quantity of one of both belongs to, as in its label; empty for others."""
        of_one = _OF_A_BODY.search(self.header) is not None
        return self.label.rpartition(", ")[2] if of_one and ", " in self.label else ""

    def of_bodies(self, names: Sequence[str]) -> Quantity:
        """Quantity whose label calls the first and the second body by their names."""
        label = re.sub(r"\bbody ([12])$", lambda found: names[int(found[1]) - 1], self.label)
        return replace(self, label=label)

    def drawn(self, values):
        """Convert SI values to the unit of plots."""
        if self.unit == "°C":
            return values - 273.15
        known = {name: scale for _, name, scale in _MULTIPLES.get(self.si, ())}
        scale = 1.0 if self.unit == (self.si or "1") else known[self.unit]
        return scale * values + 0.0  # no negative zeros

    def in_model(self, model: str) -> Quantity:
        """Quantity whose label names the coordinates as the kinematic model does."""
        if model != "axisymmetric":
            return self
        label = re.sub(r"\b[xy]\b", lambda name: _AXISYMMETRIC[name[0]], self.label)
        return replace(self, label=label)

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

    def given(self, points) -> Table:
        """Table without the optional columns that are NaN at all points."""
        absent = {
            name
            for name, quantity in self.columns.items()
            if quantity.optional and np.isnan(getattr(points, name)).all()
        }
        kept = {name: each for name, each in self.columns.items() if name not in absent}
        return replace(self, columns=kept)

    def values(self, source) -> list:
        """Columns of points, or cells of a row, in the order of the file."""
        return [getattr(source, name) for name in self.columns]

    def arrays(self, source) -> dict[str, np.ndarray]:
        """Columns of points, or of a list of rows, by their headers."""
        if isinstance(source, list):
            table, columns = self, list(zip(*map(self.values, source), strict=True))
        else:
            table = self.given(source)
            columns = table.values(source)
        headers = (quantity.header for quantity in table.columns.values())
        return dict(zip(headers, map(np.asarray, columns), strict=True))


TABLES: dict[str, Table] = {}
"""All tables by the stems of their files."""


def column(
    label: str,
    si: str = "",
    unit: str = "",
    meaning: str = "",
    header: str = "",
    optional: bool = False,
) -> Any:
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
    optional : bool
        Leave the column out where it has no values.
    """
    quantity = Quantity(header, label, si, unit or si or "1", meaning, optional)
    return field(metadata={"quantity": quantity})


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
