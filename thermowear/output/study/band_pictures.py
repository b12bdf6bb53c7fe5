"""Picture of the bands of curves: medians and 95 % intervals over time and along the contact."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from ...results.quantity import TABLES, Quantity
from ..files import bodies_of
from ..pictures.panels import BODIES, panels
from .record import StudyRecord
from .tables import BANDS, read_columns

_PANEL = (4.6, 2.6)
_PAIRED = ("wear_volume", "wear", "temperature", "max_wear")
"""Quantities of both bodies that share a panel."""


@dataclass(frozen=True)
class _Curves:
    """Bands of one table: abscissa, and quantities with their quantiles."""

    name: str
    across: tuple[Quantity, np.ndarray]
    groups: list[list[tuple[Quantity, np.ndarray]]]


def draw_bands(record: StudyRecord, path: Path) -> list[str]:
    """Draw ``bands.png``; returns reasons for what is missing.

    Raises
    ------
    ValueError
        If a file is no table of bands.
    """
    found, notes = [], []
    for file in sorted(record.folder.glob(f"{BANDS}*.csv")):
        try:
            curves = _read(record, file)
        except KeyError as missing:
            raise ValueError(f"{file}: is no table of bands, as {missing} is unknown") from None
        if curves is None:
            notes.append(f"{file.name}: not drawn, as its points are not on a line")
        elif curves.groups:
            found.append(curves)
    count = sum(len(curves.groups) for curves in found)
    if not count:
        return notes
    with panels(path, count, 2, _PANEL) as (_, axes):
        drawn = iter(axes.flat)
        for curves in found:
            for group in curves.groups:
                _plot(next(drawn), curves, group)
    return notes


def _read(record: StudyRecord, path: Path) -> _Curves | None:
    """Bands of a file; None for the points of a surface."""
    columns = read_columns(path)
    stem, _, contact = path.stem.removeprefix(BANDS).partition("_")
    bodies = bodies_of(record.folder, contact)
    known = {
        q.header: q.in_model(record.model).of_bodies(bodies) for q in TABLES[stem].columns.values()
    }
    if stem == "history":
        across = known["time_s"], columns["time_s"]
    else:
        flat = "s_m" not in columns or np.ptp(columns["y_m"]) <= 0.1 * np.ptp(columns["x_m"])
        header = "x_m" if flat else "s_m"
        across = known[header], known[header].drawn(columns[header])
        if "s_m" not in columns:
            return None
    headers = dict.fromkeys(name.removesuffix("_50") for name in columns if name.endswith("_50"))
    groups: dict[str, list[tuple[Quantity, np.ndarray]]] = {}
    for header in headers:
        values = np.array([columns[f"{header}_{level}"] for level in ("2.5", "50", "97.5")])
        quantity = known[header]
        own = groups.setdefault(_panel(header), [])
        own.append((quantity, quantity.drawn(values)))
    return _Curves(contact, across, list(groups.values()))


def _panel(header: str) -> str:
    """Panel of a quantity: both bodies share one."""
    for name in _PAIRED:
        if header.startswith((f"{name}_1", f"{name}_2")):
            return name
    return header


def _plot(axis: Axes, curves: _Curves, group: list[tuple[Quantity, np.ndarray]]) -> None:
    quantity, x = curves.across
    for (drawn, (low, median, high)), color, line in zip(group, BODIES, "-:", strict=False):
        label = drawn.body if len(group) > 1 else None
        axis.plot(x, median, line, color=color, label=label)
        axis.fill_between(x, low, high, color=color, alpha=0.25, linewidth=0)
    axis.set_xlabel(quantity.axis)
    first = group[0][0]
    axis.set_ylabel((first.of_both if len(group) > 1 else first).wrapped)
    if curves.name:
        axis.set_title(curves.name, fontsize="small")
    if len(group) > 1:
        axis.legend()
