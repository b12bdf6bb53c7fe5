"""Picture of the bands of curves: medians and 95 % intervals over time and along the contact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from ...results.quantity import TABLES, Quantity
from ..files import bodies_of
from ..pictures.panels import BODIES, panels
from .folder import BANDS, read_columns
from .record import StudyRecord, read_study, short

_BAND_PANEL = (4.6, 2.6)
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
    with panels(path, count, 2, _BAND_PANEL) as (_, axes):
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


_PANEL = (3.9, 2.7)
_ACROSS = 3
_MOST_INPUTS = 8
_BAR = 0.36  # height of a bar, where the distance of two inputs is 1
_LINE = 0.34  # height of an input in a diagram [inches]
_LEAST = 1e-3  # swing of an input that is drawn, relative to the largest one
_LOW, _HIGH = "tab:blue", "tab:orange"


def draw_study(folder: Path) -> list[str]:
    """Draw ``distributions.png``, ``tornado.png``, ``sobol.png`` and ``bands.png``.

    Returns
    -------
    list of str
        Reasons for missing pictures, one line each.

    Raises
    ------
    ValueError
        If the folder contains no study.
    """
    record = read_study(folder)
    if not record.outputs:
        return [f"{folder}: no number varies over the samples computed so far; nothing is drawn"]
    pictures: dict[str, Callable[[StudyRecord, Path], None]] = {
        "distributions": _draw_distributions,
        "tornado": _draw_tornado,
    }
    if record.indices:
        pictures["sobol"] = _draw_sobol
    for name, draw in pictures.items():
        draw(record, folder / f"{name}.png")
    return draw_bands(record, folder / "bands.png")


def _draw_distributions(record: StudyRecord, path: Path) -> None:
    """Draw histograms of the main outputs with their 95 % intervals."""
    with panels(path, len(record.main), _ACROSS, _PANEL) as (_, axes):
        for axis, output in zip(axes.flat, record.main, strict=False):
            quantity = record.quantity(output)
            values = quantity.drawn(record.sample[output])
            values = values[np.isfinite(values)]
            bins = int(np.clip(np.sqrt(len(values)), 8, 40))
            axis.hist(values, bins, color="tab:blue", alpha=0.75)
            marks = (quantity.drawn(record.quantile(output, q)) for q in ("2.5%", "50%", "97.5%"))
            low, median, high = marks
            axis.axvline(median, color="k", linewidth=1.2)
            axis.axvspan(low, high, color="tab:blue", alpha=0.12, linewidth=0)
            told = f"median {median:.4g}, 95 %: {low:.4g} … {high:.4g}"
            axis.set_title(told, fontsize="small")
            axis.yaxis.set_major_locator(MaxNLocator(5, integer=True))
            axis.xaxis.set_major_locator(MaxNLocator(5))
            axis.set_xlabel(quantity.axis)
        for axis in axes[:, 0]:
            axis.set_ylabel("samples")


def _draw_tornado(record: StudyRecord, path: Path) -> None:
    """Draw the swings of the main outputs, the input with the largest one at the top."""
    count = min(_MOST_INPUTS, len({row["input"] for row in record.swings}))
    size = (4.6, 1.0 + 1.25 * _LINE * count)
    with panels(path, len(record.main), 2, size) as (figure, axes):
        for axis, output in zip(axes.flat, record.main, strict=False):
            rows = [row for row in record.swings if row["output"] == output]
            _plot_swings(axis, record, output, rows)
        handles, labels = axes.flat[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2)


def _plot_swings(axis: Axes, record: StudyRecord, output: str, rows: list[dict[str, str]]) -> None:
    quantity = record.quantity(output)
    names = ("output_at_medians", "output_at_low", "output_at_high")
    base, low, high = (quantity.drawn(np.array([float(r[n]) for r in rows])) for n in names)
    width = np.nan_to_num(np.abs(high - low))
    order = np.argsort(width)[-_MOST_INPUTS:]
    order = order[width[order] > _LEAST * width.max()]
    places = np.arange(len(order))
    for values, color, label in (
        (low, _LOW, "input at its 5 % quantile"),
        (high, _HIGH, "input at its 95 % quantile"),
    ):
        reach = values[order] - base[order]
        axis.barh(places, reach, 2 * _BAR, base[order], color=color, label=label)
    axis.axvline(base[0], color="k", linewidth=0.8)
    keys = [short(record.label(rows[k]["input"])) for k in order]
    axis.set_yticks(places, keys, fontsize="x-small")
    axis.set_ylim(len(order) - min(_MOST_INPUTS, len(rows)) - 0.6, len(order) - 0.4)
    axis.grid(axis="y", visible=False)
    axis.xaxis.set_major_locator(MaxNLocator(6))
    axis.set_xlabel(quantity.axis)


def _draw_sobol(record: StudyRecord, path: Path) -> None:
    """Draw first-order and total indices of the main outputs with their intervals."""
    inputs = list(dict.fromkeys(row["input"] for row in record.indices))
    size = (2.9, 1.0 + 1.25 * _LINE * len(inputs))
    options: dict[str, Any] = {"sharex": True, "sharey": True}
    with panels(path, len(record.main), _ACROSS, size, margin=(1.0, 0.3), **options) as drawn:
        figure, axes = drawn
        for axis, output in zip(axes.flat, record.main, strict=False):
            rows = {row["input"]: row for row in record.indices if row["output"] == output}
            _plot_indices(axis, [rows[name] for name in inputs])
            axis.set_title(record.quantity(output).label, fontsize="small")
            axis.tick_params(axis="y", labelsize="x-small")
            axis.label_outer()
        axes.flat[0].set_yticks(range(len(inputs)), list(map(short, inputs)))
        axes.flat[0].invert_yaxis()
        axes.flat[0].set_xlim(-0.05, 1.1)
        handles, labels = axes.flat[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2)


def _plot_indices(axis: Axes, rows: list[dict[str, str]]) -> None:
    places = np.arange(len(rows))
    shown = (("first_order", "first-order index", _LOW), ("total", "total index", _HIGH))
    for side, (name, label, color) in zip((-0.5, 0.5), shown, strict=True):
        value, low, high = (
            np.array([float(row[key]) for row in rows])
            for key in (name, f"{name}_lower", f"{name}_upper")
        )
        spread = np.maximum([value - low, high - value], 0.0)
        width = {"elinewidth": 0.8}
        place = places + side * _BAR
        axis.barh(place, value, _BAR, xerr=spread, color=color, label=label, error_kw=width)
    axis.grid(axis="y", visible=False)
    axis.set_xlabel("share in the variance")
