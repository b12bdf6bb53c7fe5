"""Shapes of the disturbances of a stability analysis."""

from __future__ import annotations

from math import pi
from pathlib import Path
from textwrap import fill

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import tables
from ..quantities import INTERFACE, MODES
from .curves import STYLE, abscissa
from .maps import is_surface, triangulated

_TITLE = 38  # letters over a map
_LEVELS = np.linspace(-1.0, 1.0, 21)


def draw_modes(folder: Path) -> None:
    """``mode.png``: the disturbance that grows fastest, and those that stay at a speed."""
    if not (folder / "mode.csv").is_file():
        return
    data = tables.read(folder / "mode.csv", MODES)
    numbers = np.unique(data["mode"])
    modes = [{k: v[data["mode"] == number] for k, v in data.items()} for number in numbers]
    if not modes:
        return
    with mpl.rc_context(STYLE):
        draw = _maps if is_surface(folder) else _curves
        draw(modes).savefig(folder / "mode.png")


def _curves(modes: list[dict]) -> Figure:
    growing = [[mode] for mode in modes if not _stays(mode)]
    staying = [mode for mode in modes if _stays(mode)]
    groups = [*growing, *([staying] if staying else [])]
    figure = Figure(figsize=(6.4, 3.1 * len(groups)), layout="constrained", dpi=150)
    axes = figure.subplots(len(groups), sharex=True, squeeze=False)[:, 0]
    for axis, group in zip(axes, groups, strict=True):
        for mode in group:
            label, place = abscissa(mode)
            axis.plot(place, mode["pressure"], label=_told(mode))
            if mode["frequency"][0] > 0:
                later = "a quarter of a period later"
                axis.plot(place, -mode["pressure_imaginary"], "--", label=later)
        axis.axhline(0.0, color="0.6", linewidth=0.8)
        axis.set_ylabel(f"{MODES['pressure'].label}\n[{MODES['pressure'].unit}]")
        axis.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=9)
    axes[-1].set_xlabel(label)
    return figure


def _maps(modes: list[dict]) -> Figure:
    """On a surface: a map each, seen from above."""
    columns = min(len(modes), 2)
    rows = -(-len(modes) // columns)
    figure = Figure(figsize=(3.6 * columns, 3.2 * rows), layout="constrained", dpi=150)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for axis, mode in zip(axes, modes, strict=False):
        drawn = _map(axis, mode)
        axis.set_title(fill(_told(mode), _TITLE), fontsize=9)
    for axis in axes[len(modes) :]:
        axis.set_visible(False)
    figure.colorbar(drawn, ax=axes, label=MODES["pressure"].label, shrink=0.6)
    return figure


def _map(axis: Axes, mode: dict):
    x, y = (INTERFACE[name].drawn(mode[name]) for name in ("x", "y"))
    drawn = axis.tricontourf(triangulated(x, y), mode["pressure"], levels=_LEVELS, cmap="coolwarm")
    axis.set_aspect("equal")
    axis.set_xlabel(INTERFACE["x"].axis)
    axis.set_ylabel(INTERFACE["y"].axis)
    return drawn


def _stays(mode: dict) -> bool:
    return mode["growth_rate"][0] == 0 and mode["frequency"][0] == 0


def _told(mode: dict) -> str:
    """What a mode does, at which speed."""
    factor, rate, frequency = (mode[k][0] for k in ("speed_factor", "growth_rate", "frequency"))
    at = "at the given speed" if factor == 1.0 else f"at {factor:.4g} times the speed"
    if _stays(mode):
        return f"stays {at}"
    words = [f"grows e-fold in {1 / rate:.3g} s"] if factor == 1.0 else []
    words += [f"swings with a period of {2 * pi / frequency:.3g} s"] if frequency > 0 else []
    return f"{', '.join(words)} {at}"
