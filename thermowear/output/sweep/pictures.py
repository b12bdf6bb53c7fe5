"""Pictures of a sweep, drawn from its files: curves or maps of the variants, and key figures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D

from ...results.quantity import from_key
from ...results.summary_keys import of_key
from .. import tables
from ..files import model_of
from ..pictures.kinds import is_surface
from ..pictures.maps import triangulated
from ..pictures.panels import (
    MAP_STYLE,
    clip_singular,
    color_map,
    label_coordinates,
    panels,
    plot_along,
)
from ..variants.folder import MAIN
from .layout import (
    LINES,
    Layout,
    VariantRecord,
    add_legend,
    is_wide,
    lay_out,
    legend_height,
    read_sweep,
)

_EQUAL = 1e-6
"""Relative difference below which numbers, or curves, are considered equal."""
_MOST_MAPS, _ACROSS, _LEVELS = 12, 4, 12
_MARKED = 25
_LISTED = 24  # entries of a legend
_PLACE = from_key("x_m", "position of the largest pressure, x", "mm")
_KEYS = ("max_pressure_Pa", _PLACE.header, *MAIN)
_NUMBERS = {key: _PLACE if key == _PLACE.header else of_key(key) for key in _KEYS}
"""Quantities that are drawn, by their columns."""


def draw_sweep(folder: Path) -> list[str]:
    """Draw ``shapes.png`` and ``sweep.png``.

    Returns
    -------
    list of str
        Reasons for missing pictures, one line each.

    Raises
    ------
    ValueError
        If the folder contains no sweep.
    """
    record = read_sweep(folder)
    if not record.folders:
        return [f"{folder}: no variant was completed, so nothing is drawn"]
    layout, notes = lay_out(record), []
    pictures = {}
    if _is_pair(record):
        in_space = is_surface(record.folders[0])
        pictures["shapes.png"] = _draw_maps if in_space else _draw_curves
    pictures["sweep.png"] = _draw_numbers
    for name, draw in pictures.items():
        try:
            draw(layout, folder / name)
        except tables.MissingColumnError as reason:
            notes.append(f"{folder}: no {name}, as {reason}")
    return notes


def _is_pair(record: VariantRecord) -> bool:
    """True for variants of two bodies, with one contact."""
    return all((folder / "interface.csv").is_file() for folder in record.folders)


def _draw_curves(layout: Layout, path: Path) -> None:
    """Draw shape and pressure of each variant along the contact."""
    data = [tables.read(f / "interface.csv") for f in layout.record.folders]
    names = ["pressure", "shape"] if _is_worn(data) else ["pressure"]
    same = {name for name in names if alike([d[name] for d in data])}
    columns, keys = len(layout.columns), _legends(layout)
    below = max(map(legend_height, keys.values()), default=0.0)
    margin = (max(1.4, 7.4 - 3.4 * columns), 0.4 + below)
    options: dict[str, Any] = {"margin": margin, "sharex": True, "sharey": "row"}
    with panels(path, len(names) * columns, columns, (3.4, 2.9), **options) as (figure, axes):
        for column, (title, chosen) in zip(axes.T, layout.columns, strict=True):
            column[0].set_title(title, fontsize="medium")
            for k in np.flatnonzero(chosen):
                indices = layout.record.indices[k]
                color, line = layout.color(indices[layout.colored]), layout.line(indices)
                for axis, name in zip(column, names, strict=True):
                    style = ("-", "0.3") if name in same else (line, color)
                    plot_along(axis, data[k], name, style[0], color=style[1], linewidth=1.2)
                    axis.label_outer()
        for axis, name in zip(axes[:, 0], names, strict=True):
            axis.set_ylabel(data[0].quantities[name].wrapped)
            if name in same:
                axis.text(0.5, 0.05, "identical", ha="center", transform=axis.transAxes)
        axes[0, 0].set_ylim(bottom=0)
        clip_singular(axes[0, 0], [d.drawn("pressure") for d in data])
        if layout.continuous:
            figure.colorbar(layout.scale(), ax=axes, label=layout.axis.label, pad=0.01)
        for side, (title, handles) in zip(("left", "right"), keys.items(), strict=False):
            add_legend(figure, f"outside lower {side}", title, handles)


def _is_worn(data: list[tables.TableColumns]) -> bool:
    return any(np.ptp(d["shape"]) > 0 for d in data)


def _legends(layout: Layout) -> dict[str, list[Line2D]]:
    """Legend entries of colours and line styles, by key."""
    found, used = {}, sorted(set(layout.record.indices[:, layout.colored]))
    if not layout.continuous and len(used) > 1:
        found[layout.axis.key] = [
            Line2D([], [], color=layout.color(k), label=layout.axis.words[k]) for k in used
        ]
    if layout.lined is not None:
        axis = layout.record.axes[layout.lined]
        found[axis.key] = [
            Line2D([], [], color="0.3", linestyle=LINES[k], label=word)
            for k, word in enumerate(axis.words)
        ]
    return found


def alike(curves: list[np.ndarray]) -> bool:
    """Test whether all curves coincide."""
    first, *others = curves
    if not others or any(len(curve) != len(first) for curve in others):
        return False
    nearest = _EQUAL * np.nanmax(np.abs(first))
    return all(np.allclose(curve, first, 0.0, nearest, equal_nan=True) for curve in others)


def _draw_maps(layout: Layout, path: Path) -> None:
    """Draw maps of up to twelve variants with a common scale; of more, evenly spaced ones."""
    record = layout.record
    count = min(len(record.folders), _MOST_MAPS)
    chosen = np.unique(np.linspace(0, len(record.folders) - 1, count).round().astype(int))
    data = [tables.read(record.folders[k] / "interface.csv") for k in chosen]
    name = "shape" if _is_worn(data) else "pressure"
    values = [d.drawn(name) for d in data]
    levels = np.linspace(
        np.min(np.concatenate(values)), np.max(np.concatenate(values)), _LEVELS + 1
    )
    scale = ScalarMappable(Normalize(levels[0], levels[-1]), color_map("shape"))
    options: dict[str, Any] = {"margin": (1.4, 0.3), "style": MAP_STYLE}
    options |= {"sharex": True, "sharey": True}
    with panels(path, count, _ACROSS, (2.6, 2.7), **options) as (figure, axes):
        for axis, k, variant, z in zip(axes.flat, chosen, data, values, strict=False):
            triangles = triangulated(variant.drawn("x"), variant.drawn("y"))
            axis.tricontourf(triangles, z, levels=levels, cmap=scale.cmap, norm=scale.norm)
            label_coordinates(axis, variant)
            axis.label_outer()
            words = [key.words[i] for key, i in zip(record.axes, record.indices[k], strict=True)]
            named = record.named(range(len(words)), words)
            axis.set_title("\n".join(named), fontsize="small")
        figure.colorbar(scale, ax=axes, label=data[0].quantities[name].axis, pad=0.01)


def _draw_numbers(layout: Layout, path: Path) -> None:
    """Draw the key figures that vary over the swept key, and list the others in the title."""
    record, numbers = layout.record, _numbers(layout.record)
    model = model_of(record.folders[0])
    shown = {name: quantity.in_model(model) for name, quantity in _NUMBERS.items()}
    same = {k: v[0] for k, v in numbers.items() if np.ptp(v) <= _EQUAL * np.abs(v).max()}
    varying = {name: values for name, values in numbers.items() if name not in same}
    if not varying:
        return
    options: dict[str, Any] = {"margin": (0.6, 0.6), "sharex": True}
    with panels(path, len(varying), 2, (4.0, 2.5), **options) as (figure, axes):
        drawn = axes.ravel()[: len(varying)]
        for axis, (name, values) in zip(drawn, varying.items(), strict=True):
            _plot_numbers(axis, layout, shown[name].drawn(values))
            axis.set_ylabel(shown[name].wrapped)
        for axis in drawn[-axes.shape[1] :]:
            axis.set_xlabel(layout.axis.label)
            axis.tick_params(labelbottom=True)
        handles = drawn[0].get_lines()[:_LISTED]
        if len(handles) > 1:
            title = ", ".join(record.axes[k].key for k in layout.others)
            add_legend(figure, "outside lower center", title, handles)
            figure.set_figheight(figure.get_figheight() + legend_height(handles))
        if same:
            listed = (
                f"{shown[k].label} {shown[k].drawn(v):.6g} {shown[k].unit}" for k, v in same.items()
            )
            figure.suptitle(f"constant: {'; '.join(listed)}", fontsize="small")


def _plot_numbers(axis, layout: Layout, values: np.ndarray) -> None:
    """Draw a line per combination of the other keys."""
    across = layout.axis.numbers or tuple(range(len(layout.axis.words)))
    for number, (words, chosen) in enumerate(layout.record.groups(layout.others)):
        x = np.array([across[index] for index in layout.record.indices[chosen, layout.colored]])
        order = np.argsort(x)
        axis.plot(
            x[order],
            values[chosen][order],
            LINES[number // 10 % len(LINES)],
            color=f"C{number % 10}",
            marker="o" if len(across) <= _MARKED else None,
            markersize=3.5,
            label=", ".join(words),
        )
    if layout.axis.numbers is None:
        axis.set_xticks(across, layout.axis.words)
        axis.margins(x=0.1)
    elif is_wide(across):
        axis.set_xscale("log")


def _numbers(record: VariantRecord) -> dict[str, np.ndarray]:
    """Numbers present in all variants, and the position of the largest pressure."""
    found = dict(record.numbers)
    if _is_pair(record):
        data = (tables.read(folder / "interface.csv") for folder in record.folders)
        found[_PLACE.header] = np.array([d["x"][np.argmax(d["pressure"])] for d in data])
    known = {name: found[name] for name in _NUMBERS if name in found}
    return {name: v for name, v in known.items() if np.isfinite(v).all() and v.any()}
