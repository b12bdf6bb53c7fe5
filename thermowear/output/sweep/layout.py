"""Reading of a sweep, and assignment of its keys to colours, lines and panels."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from textwrap import wrap
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from ..files import read_object
from ..variants.units import QUANTITY, in_header, in_pictures, in_si, value_at

_LONG = 44  # characters in a line of a legend


@dataclass(frozen=True)
class Swept:
    """Swept key with its value in each variant.

    Attributes
    ----------
    key : str
        Path of the key.
    header : str
        Column name, with the SI unit of a quantity.
    values : tuple of float or str
        Values in SI, or as given by the user.
    """

    key: str
    header: str
    values: tuple[float | str, ...]


@dataclass(frozen=True)
class Axis:
    """Swept key in a picture.

    Attributes
    ----------
    key : str
    label : str
        Key with the unit of the given values.
    numbers : tuple of float or None
        Distinct values; None if they are not numeric.
    words : tuple of str
        Distinct values as text.
    """

    key: str
    label: str
    numbers: tuple[float, ...] | None
    words: tuple[str, ...]


def swept(key: str, written: Sequence[str], tables: Sequence[dict[str, Any]]) -> Swept:
    """Swept key with its column of values.

    Parameters
    ----------
    key : str
    written : sequence of str
        Value given for each variant.
    tables : sequence of dict
        Case of each variant with all default values.
    """
    resolved: list[Any] = [value_at(key, table) for table in tables]
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in resolved):
        return Swept(key, key, tuple(resolved))
    found = [in_si(value) for value in resolved]
    units = {unit for _, unit in filter(None, found)}
    if None in found or not units:
        return Swept(key, key, tuple(text.strip() for text in written))
    unit = units.pop() if len(units) == 1 else "SI"
    return Swept(key, f"{key}_{in_header(unit)}", tuple(pair[0] for pair in found if pair))


def axis(key: str, written: Sequence[str], values: Sequence[float | str], header: str) -> Axis:
    """Label and values of a key in pictures: in the given unit if it is common, else in SI.

    Parameters
    ----------
    key : str
    written : sequence of str
        Distinct values as given by the user.
    values : sequence of float or str
        Distinct values in SI.
    header : str
        Header of the column.
    """
    found = [QUANTITY.fullmatch(text) for text in written]
    words = tuple("\n".join(wrap(re.sub("[{}\"']", "", text).strip(), _LONG)) for text in written)
    units = {match[2] or "" for match in found if match}
    if None not in found and len(units) == 1:
        unit = in_pictures(units.pop())
        numbers = tuple(float(match[1]) for match in found if match)
        return Axis(key, f"{key} [{unit}]" if unit else key, numbers, words)
    if all(isinstance(value, float) for value in values):
        unit = header.removeprefix(key).lstrip("_").replace("_", " ")
        return Axis(key, f"{key} [{unit}]" if unit else key, tuple(map(float, values)), words)
    return Axis(key, key, None, words)


LINES = ("-", "--", "-.", ":")
_LEGEND_LIMIT = 6
_LEGEND_LINE = 0.22  # height of a line of a legend [inches]
_SHORT = 14  # characters of a legend entry, up to which several entries stand side by side
_LEGEND_COLUMNS = 4
_MOST_COLUMNS = 6
_LOG_RATIO = 30.0
"""Smallest ratio of largest to smallest value for a logarithmic axis; the values must also be more
evenly spaced on it."""


@dataclass(frozen=True)
class VariantRecord:
    """Completed variants of a sweep.

    Attributes
    ----------
    axes : tuple of Axis
        Swept keys.
    indices : ndarray of int, shape (n, n_axes)
        Index of the value of each key in each variant.
    folders : list of Path
        Results folder of each variant.
    numbers : dict of str to ndarray, shape (n,)
        Columns of ``sweep.csv`` other than the swept keys.
    """

    axes: tuple[Axis, ...]
    indices: np.ndarray
    folders: list[Path]
    numbers: dict[str, np.ndarray]

    def groups(self, keys: Sequence[int]) -> Iterator[tuple[list[str], np.ndarray]]:
        """Words of each combination of values of some keys, and the mask of its variants."""
        for combination in np.unique(self.indices[:, keys], axis=0):
            words = [self.axes[k].words[i] for k, i in zip(keys, combination, strict=True)]
            yield words, (self.indices[:, keys] == combination).all(axis=1)

    def named(self, keys: Sequence[int], words: Sequence[str]) -> list[str]:
        """Words of some keys with the keys."""
        return [f"{self.axes[k].key} = {word}" for k, word in zip(keys, words, strict=True)]


def read_sweep(folder: Path) -> VariantRecord:
    """Read the completed variants of a sweep.

    Raises
    ------
    ValueError
        If the folder contains no sweep.
    """
    over = (read_object(folder / "run.json") or {}).get("over")
    if not isinstance(over, dict) or not all(map(_is_list_of_words, over.values())):
        raise ValueError(f"{folder / 'run.json'}: is damaged: over: must be lists of values")
    with (folder / "sweep.csv").open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    try:
        status = header.index("status")
        keys = header[1:status]
        indices = np.array(list(product(*(range(len(values)) for values in over.values()))))
        axes = tuple(
            axis(key, written, _different(rows, k + 1, indices[:, k]), keys[k])
            for k, (key, written) in enumerate(over.items())
        )
        done = [row for row in rows if row[status] == "done"]
        cells = zip(header, *done, strict=True)
        numbers = {name: np.array(column, dtype=float) for name, *column in [*cells][status + 1 :]}
        variants = [int(row[0]) for row in done]
        folders = [folder / f"{number:03d}" for number in variants]
        return VariantRecord(axes, indices[np.array(variants, dtype=int) - 1], folders, numbers)
    except (IndexError, KeyError, ValueError) as error:
        raise ValueError(f"{folder}: run.json and sweep.csv are not of the same sweep") from error


def _is_list_of_words(values: Any) -> bool:
    return isinstance(values, list) and all(isinstance(value, str) for value in values)


def _different(rows: list[list[str]], column: int, place: np.ndarray) -> Sequence[float | str]:
    """Distinct values of a key, in the order given by the user."""
    first = [int(np.argmax(place == k)) for k in range(place.max() + 1)]
    cells = [rows[k][column] for k in first]
    try:
        return [float(cell) for cell in cells]
    except ValueError:
        return cells


@dataclass(frozen=True)
class Layout:
    """Assignment of the swept keys in a picture.

    Attributes
    ----------
    record : VariantRecord
    colored : int
        Index of the key shown by colour, or along the horizontal axis.
    lined : int or None
        Index of the key shown by line style.
    columns : list of (str, ndarray of bool)
        Title of each column of panels, and mask of its variants.
    """

    record: VariantRecord
    colored: int
    lined: int | None
    columns: list[tuple[str, np.ndarray]]

    @property
    def axis(self) -> Axis:
        """Axis of the key shown by colour."""
        return self.record.axes[self.colored]

    @property
    def others(self) -> list[int]:
        """Indices of the other keys with several values."""
        axes = self.record.axes
        return [k for k in range(len(axes)) if k != self.colored and len(axes[k].words) > 1]

    @property
    def continuous(self) -> bool:
        """True if colours form a continuous scale instead of entries of a legend."""
        return self.axis.numbers is not None and len(self.axis.words) > _LEGEND_LIMIT

    def color(self, index: int):
        """Colour of a value of the coloured key, by its index."""
        if self.continuous:
            assert self.axis.numbers is not None
            return self.scale().to_rgba(np.array(self.axis.numbers[index]))
        if self.axis.numbers is None:
            return f"C{index % 10}"
        order = np.argsort(np.argsort(self.axis.numbers))
        return mpl.colormaps["viridis"](0.85 * order[index] / max(len(order) - 1, 1))

    def scale(self) -> ScalarMappable:
        """Colour scale for a colour bar."""
        assert self.axis.numbers is not None
        low, high = min(self.axis.numbers), max(self.axis.numbers)
        norm = LogNorm(low, high) if is_wide(self.axis.numbers) else Normalize(low, high)
        return ScalarMappable(norm, "viridis")

    def line(self, indices: np.ndarray) -> str:
        """Line style of a variant, from its value indices."""
        return "-" if self.lined is None else LINES[indices[self.lined]]


def lay_out(record: VariantRecord) -> Layout:
    """Assign the swept keys to visual channels.

    The numeric key with most values is shown by colour, the next key with few values by line style;
    each combination of the remaining keys gets a column of panels.
    """
    sizes = [len(axis.words) for axis in record.axes]
    order = sorted(range(len(sizes)), key=lambda k: (record.axes[k].numbers is None, -sizes[k]))
    colored, *rest = [k for k in order if sizes[k] > 1] or [0]
    lined = next((k for k in rest if sizes[k] <= len(LINES)), None)
    rest = sorted(k for k in rest if k != lined)
    groups = list(record.groups(rest))[:_MOST_COLUMNS]
    columns = [(", ".join(record.named(rest, words)), chosen) for words, chosen in groups]
    return Layout(record, colored, lined, columns)


def is_wide(numbers) -> bool:
    """Test whether numbers suit a logarithmic axis better than a linear one."""
    if len(numbers) < 3 or min(numbers) <= 0 or max(numbers) < _LOG_RATIO * min(numbers):
        return False
    linear, logarithmic = (np.diff(np.sort(x)) for x in (numbers, np.log(numbers)))
    return bool(logarithmic.min() / logarithmic.max() > linear.min() / linear.max())


def add_legend(figure: Figure, location: str, title: str, handles: Sequence[Artist]) -> None:
    """Add a legend below the panels."""
    figure.legend(handles=handles, loc=location, title=title, ncols=_legend_columns(handles))


def legend_height(handles: Sequence[Artist]) -> float:
    """Height of a legend [inches]."""
    lines = sum(1 + str(handle.get_label()).count("\n") for handle in handles)
    return _LEGEND_LINE * (1.5 + -(-lines // _legend_columns(handles)))


def _legend_columns(handles: Sequence[Artist]) -> int:
    longest = max(len(str(handle.get_label())) for handle in handles)
    return min(_LEGEND_COLUMNS, len(handles)) if longest <= _SHORT else 1
