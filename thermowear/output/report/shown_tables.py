"""Tables of a report: few rows, in the units of plots, without rounding errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...results.quantity import Quantity
from ..tables import TableColumns
from .figures import NOISE, number

_ROWS = 20


def table_of(columns: TableColumns, caption: str, source: str) -> ShownTable:
    """Table of a file; of the points of a face in space only their number."""
    shown = _left_out if _of_a_surface(columns) else shown_table
    return shown(caption, columns, columns.quantities, source)


def _of_a_surface(columns: TableColumns) -> bool:
    """Test for points of a face in space, which have no order that a few rows could show."""
    return "s" in columns and bool(np.isnan(columns["s"]).all())


def _left_out(caption: str, columns: TableColumns, _quantities, source: str) -> ShownTable:
    """Table without rows."""
    count = len(next(iter(columns.values()), ()))
    return ShownTable(caption, f"{number(count)} points in {source}, not shown here", [], [])


@dataclass(frozen=True)
class ShownTable:
    """Table of a report as text.

    Attributes
    ----------
    caption, note : str
    heads : list of Quantity
    rows : list of list of str
    """

    caption: str
    note: str
    heads: list[Quantity]
    rows: list[list[str]]


def shown_table(
    caption: str,
    columns: Mapping[str, np.ndarray],
    quantities: Mapping[str, Quantity],
    source: str,
) -> ShownTable:
    """Table of at most twenty rows, including first and last, of the columns with content."""
    total = len(next(iter(columns.values()), ()))
    chosen = np.unique(np.linspace(0, total - 1, min(total, _ROWS)).round().astype(int))
    columns = _without_noise(columns, quantities)
    full = {name: v for name, v in columns.items() if (np.isfinite(v) & (v != 0)).any()}
    heads = [quantities[name] for name in full]
    drawn = [head.drawn(values[chosen]) for head, values in zip(heads, full.values(), strict=True)]
    rows = [[number(float(value)) for value in row] for row in zip(*drawn, strict=True)]
    note = f"{len(chosen)} of {total} rows of {source}" if len(chosen) < total else f"from {source}"
    if len(full) < len(columns):
        note += "; empty columns are left out"
    return ShownTable(caption, note, heads, rows)


def _without_noise(
    columns: Mapping[str, np.ndarray], quantities: Mapping[str, Quantity]
) -> dict[str, np.ndarray]:
    """Columns with zeros for rounding errors, compared with all columns in the same SI unit."""
    sizes: dict[str, float] = {}
    for name, values in columns.items():
        size = np.abs(values[np.isfinite(values)]).max(initial=0.0)
        sizes[quantities[name].si] = max(sizes.get(quantities[name].si, 0.0), float(size))
    sizes[""] = min(sizes.get("", 0.0), 1.0)  # numbers without a unit have no common size
    limits = {name: NOISE * sizes[quantities[name].si] for name in columns}
    return {name: np.where(np.abs(v) < limits[name], 0.0, v) for name, v in columns.items()}
