"""Mode shapes of a stability analysis."""

from __future__ import annotations

from math import pi
from pathlib import Path
from textwrap import fill

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import tables
from .curves import STYLE, abscissa, panels
from .maps import is_surface, triangulated

_TITLE = 38  # characters per line of a title
_LEVELS = np.linspace(-1.0, 1.0, 21)


def draw_modes(folder: Path) -> None:
    """Draw ``mode.png``: the fastest growing mode, and the modes at critical speeds."""
    data = tables.read(folder / "mode.csv")
    modes = [data.rows(data["mode"] == number) for number in np.unique(data["mode"])]
    if modes:
        (_draw_maps if is_surface(folder) else _draw_curves)(modes, folder / "mode.png")


def _draw_curves(modes: list[tables.TableColumns], path: Path) -> None:
    growing = [[mode] for mode in modes if not _is_stationary(mode)]
    staying = [mode for mode in modes if _is_stationary(mode)]
    groups = [*growing, *([staying] if staying else [])]
    with panels(path, len(groups), (6.4, 3.1 * len(groups)), sharex=True) as axes:
        for axis, group in zip(axes, groups, strict=True):
            for mode in group:
                label, place = abscissa(mode)
                axis.plot(place, mode["pressure"], label=_description(mode))
                if mode["frequency"][0] > 0:
                    later = "a quarter period later"
                    axis.plot(place, -mode["pressure_imaginary"], "--", label=later)
            axis.axhline(0.0, color="0.6", linewidth=0.8)
            axis.set_ylabel(group[0].quantities["pressure"].wrapped)
            axis.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=9)
        axes[-1].set_xlabel(label)


def _draw_maps(modes: list[tables.TableColumns], path: Path) -> None:
    """Draw a map of each mode, for 3D models."""
    columns = min(len(modes), 2)
    rows = -(-len(modes) // columns)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(3.6 * columns, 3.2 * rows), layout="constrained", dpi=150)
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for axis, mode in zip(axes, modes, strict=False):
            drawn = _map(axis, mode)
            axis.set_title(fill(_description(mode), _TITLE), fontsize=9)
        for axis in axes[len(modes) :]:
            axis.set_visible(False)
        label = modes[0].quantities["pressure"].label
        figure.colorbar(drawn, ax=axes, label=label, shrink=0.6)
        figure.savefig(path)


def _map(axis: Axes, mode: tables.TableColumns):
    triangles = triangulated(mode.drawn("x"), mode.drawn("y"))
    drawn = axis.tricontourf(triangles, mode["pressure"], levels=_LEVELS, cmap="coolwarm")
    axis.set_aspect("equal")
    axis.set_xlabel(mode.quantities["x"].axis)
    axis.set_ylabel(mode.quantities["y"].axis)
    return drawn


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
