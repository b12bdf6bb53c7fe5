"""Panels of pictures with a common style, and figures as files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import reduce
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.collections import TriMesh
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator
from matplotlib.tri import Triangulation
from PIL import Image

from ..tables import TableColumns

DPI = 150
_CUT = 0.01  # margin left around the content of a picture, relative to its size
_COMPRESSION = 4
"""Half the time of the default for files that are a tenth larger."""
_WHITE = 250  # least value of the channels of white


def save(figure: Figure, path: Path, crop: bool = False) -> None:
    """Write a figure as a picture; `Figure.savefig` would draw it twice, first for its layout."""
    canvas = FigureCanvasAgg(figure)
    show_as_text(figure)
    _fix_ticks(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., :3]
    picture = Image.fromarray(np.ascontiguousarray(pixels[content(pixels)] if crop else pixels))
    picture.save(path, dpi=(DPI, DPI), compress_level=_COMPRESSION)


def show_as_text(figure: Figure) -> None:
    """Draw all texts as they are: names of bodies may look like mathematics ("$").

    Those by matplotlib, on logarithmic axes, are mathematics.
    """
    for text in figure.findobj(Text):
        if "$" in text.get_text() and not text.get_text().startswith(r"$\mathdefault{"):
            text.set_parse_math(False)


def _fix_ticks(figure: Figure) -> None:
    """Keep the ticks of a first layout, as other ones would need a different width in the second.

    The two may alternate for ever, and labels would be cut off. A layout that does not change the
    ticks is the last one. Rendered bodies have no axes.
    """
    if not any(axes.axison and not hasattr(axes, "_colorbar") for axes in figure.axes):
        return
    layout = figure.get_layout_engine()
    assert layout is not None
    every = [axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)]
    before = [list(axis.get_majorticklocs()) for axis in every]
    layout.execute(figure)
    after = [list(axis.get_majorticklocs()) for axis in every]
    if after == before:
        figure.set_layout_engine("none")
        return
    for axis, places in zip(every, after, strict=True):
        if axis.get_scale() == "linear":
            axis.set_major_locator(FixedLocator(places))


def cropped(picture: np.ndarray) -> np.ndarray:
    """Picture without the white space around its content, except for a margin."""
    return picture[content(picture)]


def content(*pictures: np.ndarray) -> tuple[slice, slice]:
    """Rows and columns of the content of equally large pictures, with a margin."""
    darkest = reduce(np.minimum, pictures)
    rows = np.flatnonzero(darkest.reshape(len(darkest), -1).min(axis=1) < _WHITE)
    columns = np.flatnonzero(darkest.min(axis=0).min(axis=1) < _WHITE)
    if not len(rows):
        return np.s_[:, :]
    margin = round(_CUT * max(pictures[0].shape))
    first, last = max(rows[0] - margin, 0), rows[-1] + margin + 1
    left, right = max(columns[0] - margin, 0), columns[-1] + margin + 1
    return np.s_[first:last, left:right]


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
_SPACES = ("figure.constrained_layout.wspace", "figure.constrained_layout.hspace")
MAP_STYLE = STYLE | {"axes.grid": False} | dict.fromkeys(_SPACES, 0.06)
BODIES = ("tab:blue", "tab:orange")
_SINGULAR, _USUAL = 3.0, 0.9
"""Peaks are clipped if they exceed the first factor times the quantile of the second."""
_CLIPPED = 1.5  # end of an axis with clipped peaks, relative to that quantile
Size = tuple[float, float]  # width and height [inches]
COLORS = {
    "temperature": "inferno",
    "von_mises": "viridis",
    "pressure": "viridis",
    "fluid_pressure": "viridis",
    "shape": "cividis",
    "wear": "magma_r",
    "coating_left": "cividis",
    "shear": "viridis",
    "slip": "plasma",
    "dissipated": "magma_r",
}
_HOUR, _LONG = 3600.0, 2.0
"""Seconds of an hour, and hours from which times are shown in hours."""
SMALL_CONTACT = 0.15
"""Size of a contact relative to the bodies, below which it gets its own window."""
_WINDOW_SIZE = 3.0  # width of that window relative to the size of the contact
_MARGIN = 0.02
_PERCENTILE = 99.5  # percentile of the samples at the end of the colour range

Extent = tuple[float, float, float, float]  # left, right, lower, upper [mm]
Limits = tuple[float, float]


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
        figure = Figure(figsize=size, layout="compressed" if crop else "constrained", dpi=DPI)
        axes = figure.subplots(down, across, squeeze=False, **options)
        for unused in axes.ravel()[count:]:
            unused.set_visible(False)
        yield figure, axes
        save(figure, path, crop)


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
    name = "x" if is_flat(data) else "s"
    return data.quantities[name].axis, data.drawn(name)


def is_flat(data: TableColumns) -> bool:
    """True for the points of a nearly flat face."""
    return bool(np.ptp(data["y"]) <= 0.1 * np.ptp(data["x"]))


def plot_along(axis: Axes, data: TableColumns, name: str, line: str = "-", **options) -> None:
    """Plot a column along the contact, and label the horizontal axis."""
    label, position = abscissa(data)
    axis.plot(position, data.drawn(name), line, **options)
    axis.set_xlabel(label)


def plot_columns(axis: Axes, data: TableColumns, x: str, y: str, **options) -> None:
    """Plot a column over another one, and label both axes."""
    label, values = times(data) if x == "time" else (data.quantities[x].axis, data.drawn(x))
    axis.plot(values, data.drawn(y), **options)
    axis.set_xlabel(label)
    axis.set_ylabel(data.quantities[y].of_both.axis)


def label_coordinates(axis: Axes, data: TableColumns) -> None:
    """Label the axes of a map or section, which has the same scale in both directions."""
    axis.set_aspect("equal")
    axis.set_xlabel(data.quantities["x"].axis)
    axis.set_ylabel(data.quantities["y"].axis)


def times(data: TableColumns) -> tuple[str, np.ndarray]:
    """Label and values of a time axis, in hours for long runs."""
    unit, scale = _time_unit(data["time"].max(initial=0.0))
    return data.quantities["time"].shown_in(unit).axis, scale * data["time"]


def time_text(time: float, end: float | None = None) -> str:
    """Format a time with four digits, in the unit that suits the end of the run."""
    unit, scale = _time_unit(time if end is None else end)
    return f"{float(f'{scale * time:.4g}'):g} {unit}"


def _time_unit(end: float) -> tuple[str, float]:
    """Unit for times up to the end of a run, and its scale from seconds."""
    return ("h", 1.0 / _HOUR) if end > _LONG * _HOUR else ("s", 1.0)


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


def whole(points: np.ndarray) -> Extent:
    """Window of all points, shape (n, 2) [mm]."""
    (x0, y0), (x1, y1) = points.min(axis=0), points.max(axis=0)
    margin = _MARGIN * max(x1 - x0, y1 - y0)
    return x0 - margin, x1 + margin, y0 - margin, y1 + margin


def contact_window(
    interfaces: Sequence[Mapping[str, np.ndarray]], points: np.ndarray
) -> Extent | None:
    """Window around a contact that is small relative to the bodies; None if it is not.

    Parameters
    ----------
    interfaces : sequence of mapping
        Columns of ``interface.csv`` of one or more states; the window shows all their contacts.
    points : ndarray, shape (n, 2)
        Points of the bodies [mm].
    """
    pressed = [table["pressure"] > 0 for table in interfaces]
    x, y = (
        1e3 * np.concatenate([t[axis][p] for t, p in zip(interfaces, pressed, strict=True)])
        for axis in "xy"
    )
    if not len(x):
        return None
    reach = _WINDOW_SIZE / 2 * max(np.ptp(x), np.ptp(y))
    if 2 * reach >= _WINDOW_SIZE * SMALL_CONTACT * np.ptp(points[:, 0]):
        return None
    x, y = (v.min() + np.ptp(v) / 2 for v in (x, y))
    left, right = points[:, 0].min(), points[:, 0].max()
    return max(x - reach, left), min(x + reach, right), y - reach, y + reach


def inside(points: np.ndarray, window: Extent, margin: float = 0.0) -> np.ndarray:
    """Mask of the points in a window, with a margin relative to its size."""
    left, right, lower, upper = window
    low = np.array([left, lower]) - margin * np.array([right - left, upper - lower])
    high = np.array([right, upper]) + margin * np.array([right - left, upper - lower])
    return np.asarray(((points >= low) & (points <= high)).all(axis=1))


def proportion(window: Extent) -> float:
    """Height of a window over its width."""
    left, right, lower, upper = window
    return (upper - lower) / (right - left)


def color_limits(*states: np.ndarray) -> Limits:
    """Common colour range of several states, without the few samples near singular edges."""
    lows, highs = zip(*((v.min(), np.percentile(v, _PERCENTILE)) for v in states), strict=True)
    low, high = float(min(lows)), float(max(highs))
    return (low, high) if high > low else (low - 0.5, low + 0.5)


def color_map(name: str) -> str:
    """Colour map of a quantity, of bodies 1 and 2 alike."""
    return COLORS[re.sub("_[12]$", "", name)]


def draw_colors(
    axis: Axes,
    triangles: Triangulation,
    values: np.ndarray,
    name: str,
    limits: Limits | None = None,
    **options: Any,
) -> TriMesh:
    """Fill triangles with the colours of a quantity, shaded smoothly.

    As `Axes.tripcolor`, which makes a path of each triangle to find the limits of the axes. The
    layout would make them, too, though the axes clip all colours.
    """
    norm = Normalize(*limits) if limits else Normalize()
    mesh = TriMesh(triangles, array=values, cmap=color_map(name), norm=norm, **options)
    mesh.autoscale_None()
    mesh.set_in_layout(False)
    x, y = triangles.x, triangles.y
    axis.update_datalim([(x.min(), y.min()), (x.max(), y.max())])
    axis.autoscale_view()
    axis.add_collection(mesh, autolim=False)
    return mesh


def add_color_bar(
    axis: Axes, name: str, label: str, limits: Limits, largest: float, **options: Any
) -> None:
    """Add the colour bar of a quantity, with a tip if the largest value is beyond its limits."""
    extend = "max" if largest > limits[1] * (1 + 1e-9) else "neither"
    scale = ScalarMappable(Normalize(*limits), color_map(name))
    options = dict[str, Any](ax=axis, shrink=0.8) | options
    axis.figure.colorbar(scale, label=label, extend=extend, **options)
