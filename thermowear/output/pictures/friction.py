"""Stick, slip and fretting wear along the contact, over the load history, and over cycles."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from .. import tables
from ..coordinates import model_of
from ..quantities import CYCLES, FRICTION, LOADS
from .curves import BODIES, STYLE, abscissa, from_zero


def draw_friction(folder: Path) -> None:
    """Draw ``friction.png``: shear with its Coulomb limits, and slip, at the output times."""
    if not (folder / "friction.csv").is_file():
        return
    paths = sorted(folder.glob("friction_*.csv"), key=_time)
    states = {f"{_time(path):.4g} s": path for path in paths} | {"end": folder / "friction.csv"}
    data = {name: tables.read(path, FRICTION) for name, path in states.items()}
    colors = mpl.colormaps["viridis"](np.linspace(0.85, 0.0, len(data)))
    model = model_of(folder)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 5.6), layout="constrained", dpi=150)
        upper, lower = figure.subplots(2, sharex=True)
        for (name, table), color in zip(data.items(), colors, strict=True):
            label, place = abscissa(table, model)
            upper.plot(place, FRICTION["shear"].drawn(table["shear"]), color=color, label=name)
            slipping = np.where(table["pressure"] > 0, table["slip"], np.nan)
            lower.plot(place, FRICTION["slip"].drawn(slipping), color=color)
        limit = FRICTION["pressure"].drawn(_friction(folder) * table["pressure"])
        upper.plot(place, limit, color="0.5", linestyle=":", label="friction · pressure")
        upper.plot(place, -limit, color="0.5", linestyle=":")
        pressed = place[table["pressure"] > 0]
        margin = 0.1 * np.ptp(pressed)
        lower.set_xlim(pressed.min() - margin, pressed.max() + margin)
        lower.locator_params(axis="x", nbins=7)
        upper.set_ylabel(FRICTION["shear"].axis)
        lower.set_ylabel(FRICTION["slip"].axis)
        lower.set_xlabel(label)
        upper.legend(title="time", loc="center left", bbox_to_anchor=(1.0, 0.5))
        figure.savefig(folder / "friction.png")


def draw_loads(folder: Path) -> None:
    """Draw ``loads.png``: tangential force over displacement, and dissipated energy."""
    if not (folder / "loads.csv").is_file():
        return
    data = tables.read(folder / "loads.csv", LOADS)
    drawn = {name: quantity.drawn(data[name]) for name, quantity in LOADS.items()}
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 5.6), layout="constrained", dpi=150)
        upper, lower = figure.subplots(2)
        upper.plot(drawn["tangential_displacement"], drawn["tangential_force"], color="tab:blue")
        upper.set_xlabel(LOADS["tangential_displacement"].axis)
        upper.set_ylabel(LOADS["tangential_force"].axis)
        lower.plot(drawn["time"], drawn["dissipated"], color="tab:red")
        lower.set_xlabel(LOADS["time"].axis)
        lower.set_ylabel(LOADS["dissipated"].axis)
        figure.savefig(folder / "loads.png")


def draw_cycles(folder: Path) -> None:
    """Draw ``cycles.png``: largest wear depth and worn volume of both bodies over the cycles."""
    if not (folder / "cycles.csv").is_file():
        return
    data = tables.read(folder / "cycles.csv", CYCLES)
    worn = [body for body in (1, 2) if data[f"wear_volume_{body}"].max(initial=0.0) > 0]
    if not worn or len(data["cycle"]) < 2:
        return
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 5.0), layout="constrained", dpi=150)
        axes = figure.subplots(2, sharex=True)
        for axis, name in zip(axes, ("max_wear", "wear_volume"), strict=True):
            for body in worn:
                drawn = CYCLES[f"{name}_{body}"].drawn(data[f"{name}_{body}"])
                axis.plot(data["cycle"], drawn, color=BODIES[body - 1], label=f"body {body}")
            from_zero(axis)
        axes[0].set_ylabel(f"largest wear depth [{CYCLES['max_wear_1'].unit}]")
        axes[1].set_ylabel(f"worn volume [{CYCLES['wear_volume_1'].unit}]")
        axes[0].legend()
        axes[1].set_xlabel("cycles")
        figure.savefig(folder / "cycles.png")


def _time(path: Path) -> float:
    return float(path.stem.removeprefix("friction_"))


def _friction(folder: Path) -> float:
    return json.loads((folder / "summary.json").read_text("utf-8"))["friction"]
