"""Temperatures that are followed in time: how hot the faces get, and from what."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from .. import tables
from ..quantities import HEAT, HISTORY
from .curves import BODIES, STYLE, wrapped


def draw_heat(folder: Path) -> None:
    """``heat.png``: temperatures of both faces, friction power and largest pressure over time."""
    if not (folder / "heat.csv").is_file():
        return
    heat = tables.read(folder / "heat.csv", HEAT)
    history = tables.read(folder / "history.csv", HISTORY)
    if len(heat["time"]) < 2:
        return
    time = HEAT["time"].drawn(heat["time"])
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 6.6), layout="constrained", dpi=150)
        hot, power, pressed = figure.subplots(3, sharex=True, height_ratios=(1.6, 1, 1))
        for body, color in enumerate(BODIES, 1):
            for which, word, line in (("max", "largest", "-"), ("mean", "mean", "--")):
                name = f"{which}_temperature_{body}"
                drawn = HEAT[name].drawn(heat[name])
                hot.plot(time, drawn, line, color=color, label=f"body {body}, {word}")
        hot.set_ylabel("temperature\nof the faces [°C]")
        hot.legend(ncols=2)
        power.plot(time, HEAT["friction_power"].drawn(heat["friction_power"]), color="tab:green")
        power.set_ylabel(wrapped(HEAT["friction_power"]))
        largest = HISTORY["max_pressure"].drawn(history["max_pressure"])
        pressed.plot(HISTORY["time"].drawn(history["time"]), largest, color="tab:red")
        pressed.set_ylabel(wrapped(HISTORY["max_pressure"]))
        for axis in (power, pressed):
            axis.set_ylim(bottom=0)
        pressed.set_xlabel(HEAT["time"].axis)
        figure.savefig(folder / "heat.png")
