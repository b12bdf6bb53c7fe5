"""``shapes.png``: pressure and worn shape of all variants along the contact."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .. import tables
from ..pictures.curves import STYLE, abscissa, cut_singular
from .layout import LINES, Layout
from .legend import add_legend, tallest

_EQUAL = 1e-6
"""Relative difference below which curves are considered identical."""


def draw_shapes(layout: Layout, path: Path) -> None:
    """Draw shape and pressure of each variant."""
    data = [tables.read(f / "interface.csv") for f in layout.record.folders]
    names = ["pressure", "shape"] if any(np.ptp(d["shape"]) > 0 for d in data) else ["pressure"]
    same = {name for name in names if alike([d[name] for d in data])}
    columns = len(layout.columns)
    with mpl.rc_context(STYLE):
        keys = legends(layout)
        size = (max(7.4, 1.4 + 3.4 * columns), 2.9 * len(names) + 0.4 + tallest(keys.values()))
        figure = Figure(figsize=size, layout="constrained", dpi=150)
        axes = figure.subplots(len(names), columns, sharex=True, sharey="row", squeeze=False)
        for column, (title, chosen) in enumerate(layout.columns):
            axes[0, column].set_title(title, fontsize="medium")
            for k in np.flatnonzero(chosen):
                where, place = abscissa(data[k])
                places = layout.record.places[k]
                for axis, name in zip(axes[:, column], names, strict=True):
                    axis.plot(
                        place,
                        data[k].drawn(name),
                        "-" if name in same else layout.line(places),
                        color="0.3" if name in same else layout.color(places[layout.colored]),
                        linewidth=1.2,
                    )
            axes[-1, column].set_xlabel(where)
        for row, name in zip(axes, names, strict=True):
            row[0].set_ylabel(data[0].quantities[name].wrapped)
            if name in same:
                row[0].text(0.5, 0.05, "identical", ha="center", transform=row[0].transAxes)
        axes[0, 0].set_ylim(bottom=0)
        cut_singular(axes[0, 0], *(d.drawn("pressure") for d in data))
        if layout.continuous:
            figure.colorbar(layout.scale(), ax=axes, label=layout.axis.label, pad=0.01)
        for side, (title, handles) in zip(("left", "right"), keys.items(), strict=False):
            add_legend(figure, f"outside lower {side}", title, handles)
        figure.savefig(path)


def legends(layout: Layout) -> dict[str, list[Line2D]]:
    """Legend entries of colours and line styles, by key."""
    found, used = {}, sorted(set(layout.record.places[:, layout.colored]))
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
