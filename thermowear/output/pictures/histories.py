"""Curves over time, over the cycles, and over the load history."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .. import tables
from .panels import BODIES, column, from_zero


def draw_history(folder: Path) -> None:
    """Draw ``history.png``: largest pressure and, with wear, worn volume over time."""
    data = tables.read(folder / "history.csv")
    if len(data["time"]) < 2:
        return
    time, shown = data.drawn("time"), data.quantities
    worn = [body for body in (1, 2) if data[f"wear_volume_{body}"][-1] > 0]
    with column(folder / "history.png", 2 if worn else 1, 2.7, sharex=False) as (upper, *lower):
        upper.semilogx(time[1:], data.drawn("max_pressure")[1:], color="tab:red")
        from_zero(upper)
        upper.set_ylabel(shown["max_pressure"].axis)
        upper.set_xlabel(f"{shown['time'].axis}, logarithmic")
        for axis in lower:
            _plot_bodies(axis, data, "time", "wear_volume", worn)
            axis.legend()
            axis.set_xlabel(shown["time"].axis)


def draw_heat(folder: Path) -> None:
    """Draw ``heat.png``: surface temperatures, friction power and largest pressure over time."""
    heat = tables.read(folder / "heat.csv")
    history = tables.read(folder / "history.csv")
    if len(heat["time"]) < 2:
        return
    below = [(heat, "friction_power", "tab:green")] if np.any(heat["friction_power"]) else []
    below.append((history, "max_pressure", "tab:red"))
    count = 1 + len(below)
    options = {"margin": (0.0, 1.05), "height_ratios": (1.6, *[1] * len(below))}
    with column(folder / "heat.png", count, 1.85, **options) as (upper, *others):
        for body, color in enumerate(BODIES, 1):
            for kind, word, line in (("max", "largest", "-"), ("mean", "mean", "--")):
                values = heat.drawn(f"{kind}_temperature_{body}")
                label = f"body {body}, {word}"
                upper.plot(heat.drawn("time"), values, line, color=color, label=label)
        unit = heat.quantities["max_temperature_1"].unit
        upper.set_ylabel(f"surface\ntemperature [{unit}]")
        upper.legend(ncols=2)
        for axis, (data, name, color) in zip(others, below, strict=True):
            axis.plot(data.drawn("time"), data.drawn(name), color=color)
            axis.set_ylabel(data.quantities[name].wrapped)
            from_zero(axis)
        others[-1].set_xlabel(heat.quantities["time"].axis)


def draw_loads(folder: Path) -> None:
    """Draw ``loads.png``: tangential force over displacement, and dissipated energy."""
    data = tables.read(folder / "loads.csv")
    curves = (
        ("tangential_displacement", "tangential_force", "tab:blue"),
        ("time", "dissipated", "tab:red"),
    )
    with column(folder / "loads.png", 2, 2.8, sharex=False) as axes:
        for axis, (x, y, color) in zip(axes, curves, strict=True):
            axis.plot(data.drawn(x), data.drawn(y), color=color)
            axis.set_xlabel(data.quantities[x].axis)
            axis.set_ylabel(data.quantities[y].axis)


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
        values = data.drawn(f"{name}_{body}")
        axis.plot(data.drawn(x), values, color=BODIES[body - 1], label=f"body {body}")
    axis.set_ylabel(data.quantities[f"{name}_1"].of_both.axis)
