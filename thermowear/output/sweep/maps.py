"""``shapes.png`` of 3D models: a map of the worn shape of each variant."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .. import tables
from ..pictures.curves import STYLE
from ..pictures.maps import triangulated
from .layout import Layout
from .record import VariantRecord

_MOST = 12
_ACROSS = 4
_LEVELS = 12


def draw_shape_maps(layout: Layout, path: Path) -> None:
    """Draw maps of up to twelve variants with a common scale; of more, evenly spaced ones."""
    record = layout.record
    count = min(len(record.folders), _MOST)
    chosen = np.unique(np.linspace(0, len(record.folders) - 1, count).round().astype(int))
    data = [tables.read(record.folders[k] / "interface.csv") for k in chosen]
    name = "shape" if any(np.ptp(d["shape"]) > 0 for d in data) else "pressure"
    quantities = data[0].quantities
    drawn = [d.drawn(name) for d in data]
    low, high = min(map(np.min, drawn)), max(map(np.max, drawn))
    scale = ScalarMappable(Normalize(low, high), "cividis")
    across = min(_ACROSS, count)
    down = -(-count // across)
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        size = (2.6 * across + 1.4, 2.7 * down + 0.3)
        figure = Figure(figsize=size, layout="constrained", dpi=150)
        axes = figure.subplots(down, across, sharex=True, sharey=True, squeeze=False)
        for axis, k, table, values in zip(axes.ravel(), chosen, data, drawn, strict=False):
            x, y = map(table.drawn, "xy")
            levels = np.linspace(low, high, _LEVELS + 1)
            axis.tricontourf(
                triangulated(x, y), values, levels=levels, cmap=scale.cmap, norm=scale.norm
            )
            axis.set_aspect("equal")
            axis.set_title(_named(record, k), fontsize="small")
        for axis in axes.ravel()[count:]:
            axis.set_visible(False)
        for axis in axes[-1]:
            axis.set_xlabel(quantities["x"].axis)
        for axis in axes[:, 0]:
            axis.set_ylabel(quantities["y"].axis)
        figure.colorbar(scale, ax=axes, label=quantities[name].axis, pad=0.01)
        figure.savefig(path)


def _named(record: VariantRecord, variant: int) -> str:
    places = zip(record.axes, record.places[variant], strict=True)
    return "\n".join(f"{axis.key} = {axis.words[place]}" for axis, place in places)
