"""Surface temperatures, friction power and pressure over time."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from .. import tables
from ..quantities import HEAT, HISTORY
from .curves import BODIES, STYLE, from_zero, wrapped


def draw_heat(folder: Path) -> None:
    """Draw ``heat.png``: surface temperatures, friction power and largest pressure over time."""
    if not (folder / "heat.csv").is_file():
        return
    heat = tables.read(folder / "heat.csv", HEAT)
    history = tables.read(folder / "history.csv", HISTORY)
    if len(heat["time"]) < 2:
        return
    time = HEAT["time"].drawn(heat["time"])
    below = [(HEAT, heat, "friction_power", "tab:green")] if np.any(heat["friction_power"]) else []
    below.append((HISTORY, history, "max_pressure", "tab:red"))
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 2.9 + 1.85 * len(below)), layout="constrained", dpi=150)
        heights = (1.6, *[1] * len(below))
        hot, *others = figure.subplots(len(heights), sharex=True, height_ratios=heights)
        for body, color in enumerate(BODIES, 1):
            for which, word, line in (("max", "largest", "-"), ("mean", "mean", "--")):
                name = f"{which}_temperature_{body}"
                drawn = HEAT[name].drawn(heat[name])
                hot.plot(time, drawn, line, color=color, label=f"body {body}, {word}")
        hot.set_ylabel("surface\ntemperature [°C]")
        hot.legend(ncols=2)
        for axis, (table, data, name, color) in zip(others, below, strict=True):
            axis.plot(table["time"].drawn(data["time"]), table[name].drawn(data[name]), color=color)
            axis.set_ylabel(wrapped(table[name]))
            from_zero(axis)
        others[-1].set_xlabel(HEAT["time"].axis)
        figure.savefig(folder / "heat.png")
