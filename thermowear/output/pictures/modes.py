"""Mode shapes of a stability analysis, and critical speeds by the number of hot spots."""

from __future__ import annotations

from math import pi
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from .. import tables
from ..files import name_at, picture
from .kinds import is_surface
from .maps import triangulated
from .panels import abscissa, column, label_coordinates, panels

_SYMMETRIES = {
    0: ("any symmetry", "tab:blue"),
    -1: ("antisymmetric", "tab:red"),
    1: ("symmetric", "tab:blue"),
}
_SHOWN = 12.0
"""Critical speeds up to this multiple of the lowest one are shown."""


def draw_hot_spots(folder: Path) -> None:
    """Draw ``hot_spots.png``."""
    modes = tables.read(folder / "hot_spots.csv")
    path = folder / "growth.csv"
    growth = tables.read(path) if path.is_file() else None
    with column(folder / "hot_spots.png", 1 if growth is None else 2, 3.2, sharex=False) as (
        upper,
        *lower,
    ):
        _draw_critical(upper, modes)
        for axis in lower:
            assert growth is not None
            _draw_growth(axis, growth)


def _draw_critical(axis: Axes, modes: tables.TableColumns) -> None:
    """Critical speeds by number, relative to the speed of the case."""
    along = "number" if len(np.unique(modes["number"])) > 1 else "wave_number"
    worn = np.isfinite(modes["speed_factor_with_wear"]).any()
    for symmetry in sorted(set(modes["symmetry"].astype(int))):
        label, color = _SYMMETRIES[symmetry]
        own = modes.rows(modes["symmetry"] == symmetry)
        own = own.rows(np.argsort(own[along]))
        x = own.drawn(along)
        axis.plot(x, own["speed_factor"], "o-", color=color, markersize=4, label=label)
        if worn:
            axis.plot(
                *(x, own["speed_factor_with_wear"], "x--"),
                color=color,
                markersize=5,
                label=f"{label}, with wear",
            )
    lowest = np.nanmin(modes["speed_factor"], initial=np.inf)
    highest = np.nanmax(modes["speed_factor"], initial=0.0)
    if np.isfinite(lowest):
        axis.set_ylim(0.0, 1.08 * max(min(highest, _SHOWN * lowest), 1.0))
    axis.margins(x=0.03)
    axis.axhline(1.0, color="0.5", linewidth=0.8)
    axis.text(
        *(0.995, 1.0, "speed of the case"),
        transform=axis.get_yaxis_transform(),
        ha="right",
        va="bottom",
        color="0.4",
        fontsize=9,
    )
    if along == "number":
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axis.set_xlabel(modes.quantities[along].axis.replace(" [1]", ""))
    axis.set_ylabel("critical speed\nrelative to the case")
    axis.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize=9)


def _draw_growth(axis: Axes, growth: tables.TableColumns) -> None:
    """Growth rate of the first hot spots over the speed."""
    x = growth["speed_factor"]
    axis.plot(x, growth["growth_rate"], ".-", color="tab:red", label="without wear")
    if np.isfinite(growth["growth_rate_with_wear"]).any():
        axis.plot(x, growth["growth_rate_with_wear"], "x--", color="tab:green", label="with wear")
        axis.legend(fontsize=9)
    axis.axhline(0.0, color="0.5", linewidth=0.8)
    axis.set_xlabel("speed relative to the case")
    axis.set_ylabel("growth rate\nof the first hot spots [1/s]")


_TITLE = 38  # characters per line of a title
_LEVELS = np.linspace(-1.0, 1.0, 21)


def draw_modes(folder: Path, contact: str = "") -> None:
    """Draw ``mode.png``: the fastest growing mode, and the modes at critical speeds.

    Of one contact of several bodies: the largest value 1 of a mode may be at another one.
    """
    data = tables.read(folder / name_at("mode", None, contact))
    modes = [data.rows(data["mode"] == number) for number in np.unique(data["mode"])]
    if modes:
        draw = _draw_maps if is_surface(folder) else _draw_curves
        draw(modes, folder / picture("mode", contact))


def _draw_curves(modes: list[tables.TableColumns], path: Path) -> None:
    """Draw a panel per oscillatory or growing mode, and one of all stationary modes."""
    stationary = [mode for mode in modes if _is_stationary(mode)]
    groups = [[mode] for mode in modes if not _is_stationary(mode)]
    groups += [stationary] if stationary else []
    with column(path, len(groups), 3.1) as axes:
        for axis, group in zip(axes, groups, strict=True):
            for mode in group:
                label, position = abscissa(mode)
                axis.plot(position, mode["pressure"], label=_description(mode))
                if mode["frequency"][0] > 0:
                    later = "a quarter period later"
                    axis.plot(position, -mode["pressure_imaginary"], "--", label=later)
            axis.axhline(0.0, color="0.6", linewidth=0.8)
            axis.set_xlabel(label)
            axis.set_ylabel(group[0].quantities["pressure"].wrapped)
            axis.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=9)


def _draw_maps(modes: list[tables.TableColumns], path: Path) -> None:
    """Draw a map of each mode, for 3D models."""
    with panels(path, len(modes), 2, (3.6, 3.2)) as (figure, axes):
        for axis, mode in zip(axes.flat, modes, strict=False):
            triangles = triangulated(mode.drawn("x"), mode.drawn("y"))
            colored = axis.tricontourf(triangles, mode["pressure"], levels=_LEVELS, cmap="coolwarm")
            label_coordinates(axis, mode)
            axis.set_title(fill(_description(mode), _TITLE), fontsize=9)
        label = modes[0].quantities["pressure"].label
        figure.colorbar(colored, ax=axes, label=label, shrink=0.6)


def _is_stationary(mode: tables.TableColumns) -> bool:
    return mode["growth_rate"][0] == 0 and mode["frequency"][0] == 0


def _description(mode: tables.TableColumns) -> str:
    """Describe a mode: kind, and its growth rate or critical speed."""
    factor, rate, frequency = (mode[k][0] for k in ("speed_factor", "growth_rate", "frequency"))
    kind = (
        f"oscillatory mode, period {2 * pi / frequency:.3g} s" if frequency else "stationary mode"
    )
    if factor == 1.0 and rate != 0:
        return f"{kind}, growth rate {rate:.3g} 1/s at the given speed"
    return f"{kind}, critical speed factor {factor:.4g}"
