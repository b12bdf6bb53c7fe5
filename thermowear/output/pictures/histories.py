"""Curves over time, over the cycles, and over the load history."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .. import tables
from .panels import BODIES, column, from_zero, plot_columns


def draw_history(folder: Path) -> None:
    """Draw ``history.png``: largest pressure and, with wear, worn volume over time."""
    data = tables.read(folder / "history.csv")
    if len(data["time"]) < 2:
        return
    worn = [body for body in (1, 2) if data[f"wear_volume_{body}"][-1] > 0]
    with column(folder / "history.png", 2 if worn else 1, 2.7, sharex=False) as (upper, *lower):
        plot_columns(upper, data.rows(np.s_[1:]), "time", "max_pressure", color="tab:red")
        upper.set_xscale("log")
        from_zero(upper)
        upper.set_xlabel(f"{data.quantities['time'].axis}, logarithmic")
        for axis in lower:
            _plot_bodies(axis, data, "time", "wear_volume", worn)
            axis.legend()


def draw_heat(folder: Path) -> None:
    """Draw ``heat.png``: surface temperatures, friction power and largest pressure over time."""
    heat = tables.read(folder / "heat.csv")
    history = tables.read(folder / "history.csv")
    if len(heat["time"]) < 2:
        return
    below = [(heat, "friction_power", "tab:green")] if np.any(heat["friction_power"]) else []
    below.append((history, "max_pressure", "tab:red"))
    options = {"margin": (0.0, 1.05), "height_ratios": (1.6, *[1] * len(below))}
    with column(folder / "heat.png", 1 + len(below), 1.85, **options) as (upper, *others):
        for body, color in enumerate(BODIES, 1):
            for kind, word, line in (("max", "largest", "-"), ("mean", "mean", "--")):
                style = {"color": color, "linestyle": line, "label": f"body {body}, {word}"}
                plot_columns(upper, heat, "time", f"{kind}_temperature_{body}", **style)
        upper.set_ylabel(f"surface\ntemperature [{heat.quantities['max_temperature_1'].unit}]")
        upper.legend(ncols=2)
        for axis, (data, name, color) in zip(others, below, strict=True):
            plot_columns(axis, data, "time", name, color=color)
            axis.set_ylabel(data.quantities[name].wrapped)
            from_zero(axis)


def draw_loads(folder: Path) -> None:
    """Draw ``loads.png``: tangential force over displacement, and dissipated energy."""
    data = tables.read(folder / "loads.csv")
    with column(folder / "loads.png", 2, 2.8, sharex=False) as (upper, lower):
        plot_columns(upper, data, "tangential_displacement", "tangential_force", color="tab:blue")
        plot_columns(lower, data, "time", "dissipated", color="tab:red")


def draw_cycles(folder: Path) -> None:
    """Draw ``cycles.png``: largest wear depth and worn volume of both bodies over the cycles."""
    data = tables.read(folder / "cycles.csv")
    worn = [body for body in (1, 2) if data[f"wear_volume_{body}"].max(initial=0.0) > 0]
    if not worn or len(data["cycle"]) < 2:
        return
    with column(folder / "cycles.png", 2, 2.5) as axes:
        for axis, name in zip(axes, ("max_wear", "wear_volume"), strict=True):
            _plot_bodies(axis, data, "cycle", name, worn)
            from_zero(axis)
        axes[0].legend()
        axes[1].set_xlabel("cycles")


def _plot_bodies(axis, data: tables.TableColumns, x: str, name: str, bodies: list[int]) -> None:
    """Plot a quantity of several bodies."""
    for body in bodies:
        style = {"color": BODIES[body - 1], "label": f"body {body}"}
        plot_columns(axis, data, x, f"{name}_{body}", **style)
