"""Curves along the contact and over time (matplotlib)."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import tables
from ..coordinates import in_model, model_of
from ..quantities import HISTORY, INTERFACE, LOADS, Quantity

STYLE = {key: value for key, value in mpl.rcParamsDefault.items() if key != "backend"} | {
    "font.size": 10,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
}
"""Complete settings, so that none is taken from a ``matplotlibrc`` in the current folder."""
BODIES = ("tab:blue", "tab:orange")


def from_zero(axis: Axes) -> None:
    """Let an axis begin at zero and end above the largest value, also for constant curves."""
    axis.set_ylim(0.0, 1.05 * axis.dataLim.y1 or None)


def draw_interface(folder: Path) -> None:
    """Draw ``interface.png``: pressure, temperatures and shape along the contact."""
    data = tables.read(folder / "interface.csv", INTERFACE)
    hot = np.isfinite(data["temperature_1"]).all()
    panels = [["pressure"], *([["temperature_1", "temperature_2"]] if hot else [])]
    if np.ptp(data["shape"]) > 1e-12:  # smaller ranges are rounding errors of flat unworn faces
        panels.append(["shape"])
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 2.3 * len(panels)), layout="constrained", dpi=150)
        axes = figure.subplots(len(panels), sharex=True, squeeze=False)[:, 0]
        place = abscissa(data, model_of(folder))
        for axis, names in zip(axes, panels, strict=True):
            for name, color, line in zip(names, BODIES, ("-", "--"), strict=False):
                drawn = INTERFACE[name].drawn(data[name])
                axis.plot(place[1], drawn, line, color=color, label=f"body {name[-1]}")
            if len(names) > 1:
                axis.set_ylabel("temperature\n[°C]")
                axis.legend()
            else:
                axis.set_ylabel(wrapped(INTERFACE[names[0]]))
        from_zero(axes[0])
        axes[-1].set_xlabel(place[0])
        figure.savefig(folder / "interface.png")


def draw_wear(folder: Path) -> None:
    """Draw ``wear.png``: pressure and wear depth along the contact at the output times."""
    steps = {"history.csv": HISTORY, "loads.csv": LOADS}
    ends = [
        float(tables.read(folder / name, table)["time"][-1])
        for name, table in steps.items()
        if (folder / name).is_file()
    ]
    if not ends:
        return
    files = {ends[0]: folder / "interface.csv"}
    for path in folder.glob("interface_*.csv"):
        files[float(path.stem.removeprefix("interface_"))] = path
    states = {time: tables.read(path, INTERFACE) for time, path in sorted(files.items())}
    final, model = states[max(states)], model_of(folder)
    bodies = [name for name in ("wear_1", "wear_2") if final[name].max() > 0]
    if not bodies:
        return
    colors = mpl.colormaps["viridis"](np.linspace(0.9, 0.0, len(states)))
    with mpl.rc_context(STYLE):
        panels = ["pressure", *bodies] if len(states) > 1 else bodies
        figure = Figure(figsize=(6.4, 3.0 * len(panels)), layout="constrained", dpi=150)
        axes = figure.subplots(len(panels), sharex=True, squeeze=False)[:, 0]
        for axis, name in zip(axes, panels, strict=True):
            for (time, data), color in zip(states.items(), colors, strict=True):
                label, place = abscissa(data, model)
                axis.plot(
                    place, INTERFACE[name].drawn(data[name]), color=color, label=f"{time:.4g} s"
                )
            axis.set_ylabel(INTERFACE[name].axis)
            if name != "pressure":
                axis.invert_yaxis()
        axes[0].legend(title="time", loc="center left", bbox_to_anchor=(1.0, 0.5))
        axes[-1].set_xlabel(label)
        figure.savefig(folder / "wear.png")


def draw_history(folder: Path) -> None:
    """Draw ``history.png``: largest pressure and, with wear, worn volume over time."""
    if not (folder / "history.csv").is_file():
        return
    data = tables.read(folder / "history.csv", HISTORY)
    if len(data["time"]) < 2:
        return
    time = HISTORY["time"].drawn(data["time"])
    worn = [body for body in (1, 2) if data[f"wear_volume_{body}"][-1] > 0]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 5.4 if worn else 2.7), layout="constrained", dpi=150)
        upper, *lower = figure.subplots(2 if worn else 1, squeeze=False)[:, 0]
        pressure = HISTORY["max_pressure"].drawn(data["max_pressure"])
        upper.semilogx(time[1:], pressure[1:], color="tab:red")
        from_zero(upper)
        upper.set_ylabel(HISTORY["max_pressure"].axis)
        upper.set_xlabel(f"{HISTORY['time'].axis}, logarithmic")
        for axis in lower:
            for body in worn:
                volume = HISTORY[f"wear_volume_{body}"].drawn(data[f"wear_volume_{body}"])
                axis.plot(time, volume, color=BODIES[body - 1], label=f"body {body}")
            axis.legend()
            axis.set_ylabel(f"worn volume [{HISTORY['wear_volume_1'].unit}]")
            axis.set_xlabel(HISTORY["time"].axis)
        figure.savefig(folder / "history.png")


def abscissa(data: dict[str, np.ndarray], model: str = "") -> tuple[str, np.ndarray]:
    """Label and values of the horizontal axis: x (or r) on nearly flat faces, else arc length."""
    flat = np.ptp(data["y"]) <= 0.1 * np.ptp(data["x"])
    quantity = INTERFACE["x" if flat else "s"]
    return in_model(quantity, model).axis, quantity.drawn(data["x" if flat else "s"])


def wrapped(quantity: Quantity) -> str:
    """Axis label in two lines."""
    return f"{quantity.label}\n[{quantity.unit}]"
