"""``shapes.png`` of 3D models: maps of the worn shape of the variants."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from .. import tables
from ..pictures.maps import triangulated
from ..pictures.panels import MAP_STYLE, label_coordinates, panels
from ..pictures.scales import COLORS
from .layout import Layout
from .record import VariantRecord

_MOST = 12  # maps
_ACROSS = 4
_LEVELS = 12


def draw_shape_maps(layout: Layout, path: Path) -> None:
    """Draw maps of up to twelve variants with a common scale; of more, evenly spaced ones."""
    record = layout.record
    count = min(len(record.folders), _MOST)
    chosen = np.unique(np.linspace(0, len(record.folders) - 1, count).round().astype(int))
    data = [tables.read(record.folders[k] / "interface.csv") for k in chosen]
    name = "shape" if any(np.ptp(d["shape"]) > 0 for d in data) else "pressure"
    values = [d.drawn(name) for d in data]
    levels = np.linspace(
        np.min(np.concatenate(values)), np.max(np.concatenate(values)), _LEVELS + 1
    )
    scale = ScalarMappable(Normalize(levels[0], levels[-1]), COLORS["shape"])
    options: dict[str, Any] = {
        "margin": (1.4, 0.3),
        "style": MAP_STYLE,
        "sharex": True,
        "sharey": True,
    }
    with panels(path, count, _ACROSS, (2.6, 2.7), **options) as (figure, axes):
        for axis, k, variant, z in zip(axes.flat, chosen, data, values, strict=False):
            triangles = triangulated(variant.drawn("x"), variant.drawn("y"))
            axis.tricontourf(triangles, z, levels=levels, cmap=scale.cmap, norm=scale.norm)
            label_coordinates(axis, variant)
            axis.label_outer()
            axis.set_title(_title(record, k), fontsize="small")
        figure.colorbar(scale, ax=axes, label=data[0].quantities[name].axis, pad=0.01)


def _title(record: VariantRecord, variant: int) -> str:
    indices = zip(record.axes, record.indices[variant], strict=True)
    return "\n".join(f"{axis.key} = {axis.words[index]}" for axis, index in indices)
