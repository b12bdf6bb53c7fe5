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
from ..coordinates import model_of
from ..quantities import INTERFACE, MODES
from .curves import STYLE, abscissa
from .maps import is_surface, triangulated

_TITLE = 38  # characters per line of a title
_LEVELS = np.linspace(-1.0, 1.0, 21)


def draw_modes(folder: Path) -> None:
    """Draw ``mode.png``: the fastest growing mode, and the modes at critical speeds."""
    if not (folder / "mode.csv").is_file():
        return
    data = tables.read(folder / "mode.csv", MODES)
    numbers = np.unique(data["mode"])
    modes = [{k: v[data["mode"] == number] for k, v in data.items()} for number in numbers]
    if not modes:
        return
    with mpl.rc_context(STYLE):
        figure = _maps(modes) if is_surface(folder) else _curves(modes, model_of(folder))
        figure.savefig(folder / "mode.png")


def _curves(modes: list[dict], model: str) -> Figure:
    growing = [[mode] for mode in modes if not _is_stationary(mode)]
    staying = [mode for mode in modes if _is_stationary(mode)]
    groups = [*growing, *([staying] if staying else [])]
    figure = Figure(figsize=(6.4, 3.1 * len(groups)), layout="constrained", dpi=150)
    axes = figure.subplots(len(groups), sharex=True, squeeze=False)[:, 0]
    for axis, group in zip(axes, groups, strict=True):
        for mode in group:
            label, place = abscissa(mode, model)
            axis.plot(place, mode["pressure"], label=_description(mode))
            if mode["frequency"][0] > 0:
                later = "a quarter period later"
                axis.plot(place, -mode["pressure_imaginary"], "--", label=later)
        axis.axhline(0.0, color="0.6", linewidth=0.8)
        axis.set_ylabel(f"{MODES['pressure'].label}\n[{MODES['pressure'].unit}]")
        axis.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=9)
    axes[-1].set_xlabel(label)
    return figure


def _maps(modes: list[dict]) -> Figure:
    """Draw a map of each mode, for 3D models."""
    columns = min(len(modes), 2)
    rows = -(-len(modes) // columns)
    figure = Figure(figsize=(3.6 * columns, 3.2 * rows), layout="constrained", dpi=150)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for axis, mode in zip(axes, modes, strict=False):
        drawn = _map(axis, mode)
        axis.set_title(fill(_description(mode), _TITLE), fontsize=9)
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


def _is_stationary(mode: dict) -> bool:
    return mode["growth_rate"][0] == 0 and mode["frequency"][0] == 0


def _description(mode: dict) -> str:
    """Describe a mode: kind, and its growth rate or critical speed."""
    factor, rate, frequency = (mode[k][0] for k in ("speed_factor", "growth_rate", "frequency"))
    kind = (
        f"oscillatory mode, period {2 * pi / frequency:.3g} s" if frequency else "stationary mode"
    )
    if factor == 1.0 and rate != 0:
        return f"{kind}, growth rate {rate:.3g} 1/s at the given speed"
    return f"{kind}, critical speed factor {factor:.4g}"
