"""``shapes.png``: pressure and worn shape of all variants along the contact."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from .. import tables
from ..pictures.panels import clip_singular, panels, plot_along
from .layout import LINES, Layout, add_legend, legend_height

_EQUAL = 1e-6
"""Relative difference below which curves are considered identical."""


def draw_shapes(layout: Layout, path: Path) -> None:
    """Draw shape and pressure of each variant."""
    data = [tables.read(f / "interface.csv") for f in layout.record.folders]
    names = ["pressure", "shape"] if any(np.ptp(d["shape"]) > 0 for d in data) else ["pressure"]
    same = {name for name in names if alike([d[name] for d in data])}
    columns, keys = len(layout.columns), legends(layout)
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


def legends(layout: Layout) -> dict[str, list[Line2D]]:
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
