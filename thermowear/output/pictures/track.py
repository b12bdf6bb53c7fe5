"""Wear profiles of reciprocating analyses, of the moving body and of the track."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from .. import tables
from ..quantities import INTERFACE, TRACK
from .curves import STYLE


def draw_track(folder: Path) -> None:
    """Draw ``track.png``: wear depths of both bodies, body 1 in the middle of its stroke."""
    if not (folder / "track.csv").is_file():
        return
    times = [path.stem.removeprefix("track_") for path in folder.glob("track_*.csv")]
    ends = {f"{float(time):.4g} s": f"_{time}" for time in sorted(times, key=float)} | {"end": ""}
    colors = mpl.colormaps["viridis"](np.linspace(0.9, 0.0, len(ends)))
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 5.6), layout="constrained", dpi=150)
        axes = figure.subplots(2, sharex=True)
        for (label, end), color in zip(ends.items(), colors, strict=True):
            moving = tables.read(folder / f"interface{end}.csv", INTERFACE)
            track = tables.read(folder / f"track{end}.csv", TRACK)
            for axis, data, name in zip(axes, (moving, track), ("wear_1", "wear_2"), strict=True):
                depth = INTERFACE[name].drawn(data[name])
                axis.plot(INTERFACE["x"].drawn(data["x"]), depth, color=color, label=label)
        for axis, name in zip(axes, ("wear_1", "wear_2"), strict=True):
            axis.set_ylabel(INTERFACE[name].axis)
            axis.invert_yaxis()
        axes[0].legend(title="time", loc="center left", bbox_to_anchor=(1.0, 0.5))
        axes[1].set_xlabel(INTERFACE["x"].axis)
        figure.savefig(folder / "track.png")
