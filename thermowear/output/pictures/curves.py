"""Curves along the contact and over time (matplotlib)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import tables
from ..names import states

STYLE = {key: value for key, value in mpl.rcParamsDefault.items() if key != "backend"} | {
    "font.size": 10,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
}
"""Complete settings, so that none is taken from a ``matplotlibrc`` in the current folder."""
BODIES = ("tab:blue", "tab:orange")
_FLAT = 1e-12
"""Range of shapes below which they are rounding errors of flat unworn faces [m]."""
_SINGULAR, _MOST = 3.0, 0.9
"""Peaks are clipped if they exceed the first factor times the quantile of the second."""


@contextmanager
def panels(path: Path, count: int, size: tuple[float, float], **options) -> Iterator[np.ndarray]:
    """Axes of panels one above the other, saved as a picture at the end.

    Parameters
    ----------
    path : Path
    count : int
    size : tuple of float
        Width and height [inches].
    **options
        Options of ``Figure.subplots``.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=size, layout="constrained", dpi=150)
        yield figure.subplots(count, squeeze=False, **options)[:, 0]
        figure.savefig(path)


def from_zero(axis: Axes) -> None:
    """Let an axis begin at zero and end above the largest value, also for constant curves."""
    axis.set_ylim(0.0, 1.05 * axis.dataLim.y1 or None)


def draw_interface(folder: Path) -> None:
    """Draw ``interface.png``: pressure, temperatures and shape along the contact."""
    data = tables.read(folder / "interface.csv")
    shown = interface_panels(data)
    size = (6.4, 2.3 * len(shown))
    with panels(folder / "interface.png", len(shown), size, sharex=True) as axes:
        label, place = abscissa(data)
        for axis, names in zip(axes, shown, strict=True):
            for name, color, line in zip(names, BODIES, ("-", "--"), strict=False):
                axis.plot(place, data.drawn(name), line, color=color, label=f"body {name[-1]}")
            axis.set_ylabel(data.quantities[names[0]].of_both.wrapped)
            if len(names) > 1:
                axis.legend()
        from_zero(axes[0])
        axes[-1].set_xlabel(label)


def interface_panels(data: tables.TableColumns) -> list[list[str]]:
    """Columns of ``interface.csv`` to draw, by panel: pressure, temperatures, shape if worn."""
    shown = [["pressure"]]
    if np.isfinite(data["temperature_1"]).all():
        shown.append(["temperature_1", "temperature_2"])
    if np.ptp(data["shape"]) > _FLAT:
        shown.append(["shape"])
    return shown


def draw_wear(folder: Path) -> None:
    """Draw ``wear.png``: pressure and wear depth along the contact at the output times."""
    end = final_time(folder)
    if end is None:
        return
    files = {end: folder / "interface.csv"} | states(folder, "interface")
    found = {time: tables.read(files[time]) for time in sorted(files)}
    final = found[max(found)]
    bodies = [name for name in ("wear_1", "wear_2") if final[name].max() > 0]
    if not bodies:
        return
    colors = mpl.colormaps["viridis"](np.linspace(0.9, 0.0, len(found)))
    shown = ["pressure", *bodies] if len(found) > 1 else bodies
    with panels(folder / "wear.png", len(shown), (6.4, 3.0 * len(shown)), sharex=True) as axes:
        for axis, name in zip(axes, shown, strict=True):
            for (time, data), color in zip(found.items(), colors, strict=True):
                label, place = abscissa(data)
                axis.plot(place, data.drawn(name), color=color, label=f"{time:.4g} s")
            axis.set_ylabel(final.quantities[name].axis)
            if name != "pressure":
                axis.invert_yaxis()
        axes[0].legend(title="time", loc="center left", bbox_to_anchor=(1.0, 0.5))
        axes[-1].set_xlabel(label)


def final_time(folder: Path) -> float | None:
    """Time at the end of a run in time, from its history; None without one [s]."""
    for name in ("history.csv", "loads.csv"):
        if (folder / name).is_file():
            return float(tables.read(folder / name)["time"][-1])
    return None


def draw_history(folder: Path) -> None:
    """Draw ``history.png``: largest pressure and, with wear, worn volume over time."""
    data = tables.read(folder / "history.csv")
    if len(data["time"]) < 2:
        return
    time, shown = data.drawn("time"), data.quantities
    worn = [body for body in (1, 2) if data[f"wear_volume_{body}"][-1] > 0]
    count = 2 if worn else 1
    with panels(folder / "history.png", count, (6.4, 2.7 * count)) as (upper, *lower):
        upper.semilogx(time[1:], data.drawn("max_pressure")[1:], color="tab:red")
        from_zero(upper)
        upper.set_ylabel(shown["max_pressure"].axis)
        upper.set_xlabel(f"{shown['time'].axis}, logarithmic")
        for axis in lower:
            for body in worn:
                volume = data.drawn(f"wear_volume_{body}")
                axis.plot(time, volume, color=BODIES[body - 1], label=f"body {body}")
            axis.legend()
            axis.set_ylabel(shown["wear_volume_1"].of_both.axis)
            axis.set_xlabel(shown["time"].axis)


def abscissa(data: tables.TableColumns) -> tuple[str, np.ndarray]:
    """Label and values of the horizontal axis: x (or r) on nearly flat faces, else arc length."""
    flat = np.ptp(data["y"]) <= 0.1 * np.ptp(data["x"])
    name = "x" if flat else "s"
    return data.quantities[name].axis, data.drawn(name)


def cut_singular(axis: Axes, *curves: np.ndarray) -> None:
    """Limit an axis to the usual values of its curves.

    Pressure is singular at corners of unworn faces, which would hide all other values.
    """
    usual = max(float(np.nanquantile(curve, _MOST)) for curve in curves)
    peak = max(float(np.nanmax(curve)) for curve in curves)
    if usual > 0 and peak > _SINGULAR * usual:
        axis.set_ylim(top=1.5 * usual)
