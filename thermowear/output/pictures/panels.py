"""Panels of pictures with a common style, and the horizontal axis along the contact."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..tables import TableColumns

STYLE: dict[str, Any] = {k: v for k, v in mpl.rcParamsDefault.items() if k != "backend"} | {
    "font.size": 10,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
}
"""Complete settings, so that none is taken from a ``matplotlibrc`` in the current folder."""
MAP_STYLE = STYLE | {"axes.grid": False}
BODIES = ("tab:blue", "tab:orange")
_SINGULAR, _USUAL = 3.0, 0.9
"""Peaks are clipped if they exceed the first factor times the quantile of the second."""
_CLIPPED = 1.5  # end of an axis with clipped peaks, relative to that quantile
Size = tuple[float, float]  # width and height [inches]


@contextmanager
def panels(
    path: Path,
    count: int,
    across: int,
    panel: Size,
    *,
    margin: Size = (0.0, 0.0),
    style: dict[str, Any] = STYLE,
    crop: bool = False,
    **options,
) -> Iterator[tuple[Figure, np.ndarray]]:
    """Figure and its panels, saved as a picture at the end.

    Parameters
    ----------
    path : Path
    count : int
        Number of panels; the rest of the last row remains empty.
    across : int
        Largest number of panels in a row.
    panel, margin : tuple of float
        Size of a panel, and of what is beside all panels.
    style : dict
        Settings of matplotlib.
    crop : bool
        Cut off the white space around all panels.
    **options
        Options of ``Figure.subplots``.
    """
    across = min(across, count)
    down = -(-count // across)
    size = (panel[0] * across + margin[0], panel[1] * down + margin[1])
    with mpl.rc_context(style):
        figure = Figure(figsize=size, layout="constrained", dpi=150)
        axes = figure.subplots(down, across, squeeze=False, **options)
        for unused in axes.ravel()[count:]:
            unused.set_visible(False)
        yield figure, axes
        figure.savefig(path, bbox_inches="tight" if crop else None)


@contextmanager
def column(path: Path, count: int, height: float, **options) -> Iterator[np.ndarray]:
    """Panels one above the other; options as for `panels`.

    A horizontal axis that they share is labelled below the last one.
    """
    options = {"sharex": True} | options
    with panels(path, count, 1, (6.4, height), **options) as (_, axes):
        yield axes[:, 0]
        if options["sharex"]:
            for axis in axes[:, 0]:
                axis.label_outer()


def abscissa(data: TableColumns) -> tuple[str, np.ndarray]:
    """Label and values of the horizontal axis: x (or r) on nearly flat faces, else arc length."""
    flat = np.ptp(data["y"]) <= 0.1 * np.ptp(data["x"])
    name = "x" if flat else "s"
    return data.quantities[name].axis, data.drawn(name)


def plot_along(axis: Axes, data: TableColumns, name: str, line: str = "-", **options) -> None:
    """Plot a column along the contact, and label the horizontal axis."""
    label, position = abscissa(data)
    axis.plot(position, data.drawn(name), line, **options)
    axis.set_xlabel(label)


def plot_columns(axis: Axes, data: TableColumns, x: str, y: str, **options) -> None:
    """Plot a column over another one, and label both axes."""
    axis.plot(data.drawn(x), data.drawn(y), **options)
    axis.set_xlabel(data.quantities[x].axis)
    axis.set_ylabel(data.quantities[y].of_both.axis)


def label_coordinates(axis: Axes, data: TableColumns) -> None:
    """Label the axes of a map or section, which has the same scale in both directions."""
    axis.set_aspect("equal")
    axis.set_xlabel(data.quantities["x"].axis)
    axis.set_ylabel(data.quantities["y"].axis)


def time_colors(count: int, first: float = 0.9) -> np.ndarray:
    """Colours of states in the order of time, light to dark."""
    return mpl.colormaps["viridis"](np.linspace(first, 0.0, count))


def time_legend(axis: Axes) -> None:
    """Place a legend of times at the right of a panel."""
    axis.legend(title="time", loc="center left", bbox_to_anchor=(1.0, 0.5))


def from_zero(axis: Axes) -> None:
    """Let an axis begin at zero and end above the largest value, also for constant curves."""
    axis.set_ylim(0.0, 1.05 * axis.dataLim.y1 or None)


def clipped_top(curves: Iterable[np.ndarray]) -> float | None:
    """Upper end of an axis that clips singular peaks; None if there are none.

    Pressure is singular at corners of unworn faces, which would hide all other values.
    """
    ends = [(np.nanquantile(curve, _USUAL), np.nanmax(curve)) for curve in curves]
    usual, peak = np.max(ends, axis=0)
    return float(_CLIPPED * usual) if 0 < _SINGULAR * usual < peak else None


def clip_singular(axis: Axes, curves: Iterable[np.ndarray]) -> None:
    """End an axis below singular peaks of its curves."""
    end = clipped_top(curves)
    if end is not None:
        axis.set_ylim(top=end)
