"""Surface temperatures, friction power and pressure over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .. import tables
from .curves import BODIES, from_zero, panels


def draw_heat(folder: Path) -> None:
    """Draw ``heat.png``: surface temperatures, friction power and largest pressure over time."""
    heat = tables.read(folder / "heat.csv")
    history = tables.read(folder / "history.csv")
    if len(heat["time"]) < 2:
        return
    below = [(heat, "friction_power", "tab:green")] if np.any(heat["friction_power"]) else []
    below.append((history, "max_pressure", "tab:red"))
    heights = (1.6, *[1] * len(below))
    size = (6.4, 2.9 + 1.85 * len(below))
    options = {"sharex": True, "height_ratios": heights}
    with panels(folder / "heat.png", len(heights), size, **options) as (hot, *others):
        for body, color in enumerate(BODIES, 1):
            for which, word, line in (("max", "largest", "-"), ("mean", "mean", "--")):
                drawn = heat.drawn(f"{which}_temperature_{body}")
                label = f"body {body}, {word}"
                hot.plot(heat.drawn("time"), drawn, line, color=color, label=label)
        unit = heat.quantities["max_temperature_1"].unit
        hot.set_ylabel(f"surface\ntemperature [{unit}]")
        hot.legend(ncols=2)
        for axis, (data, name, color) in zip(others, below, strict=True):
            axis.plot(data.drawn("time"), data.drawn(name), color=color)
            axis.set_ylabel(data.quantities[name].wrapped)
            from_zero(axis)
        others[-1].set_xlabel(heat.quantities["time"].axis)
