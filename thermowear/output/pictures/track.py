"""Wear profiles of reciprocating analyses, of the moving body and of the track."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np

from .. import tables
from ..names import states
from .curves import panels


def draw_track(folder: Path) -> None:
    """Draw ``track.png``: wear depths of both bodies, body 1 in the middle of its stroke."""
    files = {f"{time:.4g} s": path for time, path in states(folder, "track").items()}
    files["end"] = folder / "track.csv"
    colors = mpl.colormaps["viridis"](np.linspace(0.9, 0.0, len(files)))
    with panels(folder / "track.png", 2, (6.4, 5.6), sharex=True) as axes:
        for (label, path), color in zip(files.items(), colors, strict=True):
            moving = tables.read(path.with_name(path.name.replace("track", "interface")))
            both = ((moving, "wear_1"), (tables.read(path), "wear_2"))
            for axis, (data, name) in zip(axes, both, strict=True):
                axis.plot(data.drawn("x"), data.drawn(name), color=color, label=label)
        for axis, (data, name) in zip(axes, both, strict=True):
            axis.set_ylabel(data.quantities[name].axis)
            axis.invert_yaxis()
        axes[0].legend(title="time", loc="center left", bbox_to_anchor=(1.0, 0.5))
        axes[1].set_xlabel(data.quantities["x"].axis)
