"""Maps of a contact face of a 3D model, seen from above (matplotlib)."""

from __future__ import annotations

from itertools import chain
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.tri import Triangulation

from .. import tables
from .curves import STYLE, final_time, interface_panels

COLORS = {"pressure": "viridis", "temperature": "inferno", "shape": "cividis", "wear": "magma_r"}
_LONGER_SIDE = 4.6  # longer side of the face [inches]
_LINES = 8
_LARGEST_ANGLE = (
    100.0  # largest angle of a boundary triangle [degrees]; larger ones lie outside the face
)


def is_surface(folder: Path) -> bool:
    """Test whether the contact points of a results folder form a surface, not a line."""
    data = tables.read(folder / "interface.csv")
    return "s" in data and bool(np.isnan(data["s"]).all())


def draw_interface_maps(folder: Path) -> None:
    """Draw ``interface.png``: pressure, temperatures and shape over the face."""
    data = tables.read(folder / "interface.csv")
    _draw(folder / "interface.png", data, list(chain.from_iterable(interface_panels(data))))


def draw_wear_maps(folder: Path) -> None:
    """Draw ``wear.png``: wear depth of each body at the end of a transient analysis."""
    end = final_time(folder)
    if end is None:
        return
    data = tables.read(folder / "interface.csv")
    names = [name for name in ("wear_1", "wear_2") if data[name].max() > 0]
    if not names:
        return
    _draw(folder / "wear.png", data, names, f"wear after {end:.4g} s")


def _draw(path: Path, data: tables.TableColumns, names: list[str], title: str = "") -> None:
    """Draw a map of each quantity, two per row."""
    x, y = map(data.drawn, "xy")
    triangles = triangulated(x, y)
    columns = min(2, len(names))
    rows = -(-len(names) // columns)
    tall = np.clip(np.ptp(y) / np.ptp(x), 0.3, 2.5)
    width, height = _LONGER_SIDE / max(1.0, tall) + 2.2, _LONGER_SIDE * min(1.0, tall) + 0.8
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        size = (width * columns, height * rows + (0.3 if title else 0.0))
        layout = ConstrainedLayoutEngine(wspace=0.06, hspace=0.06)
        figure = Figure(figsize=size, layout=layout, dpi=150)
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for axis, name in zip(axes, names, strict=False):
            _map(figure, axis, triangles, data, name)
        for axis in axes[len(names) :]:
            axis.set_visible(False)
        if title:
            figure.suptitle(title, fontsize=11)
        figure.savefig(path, bbox_inches="tight")


def _map(figure, axis, triangles: Triangulation, data: tables.TableColumns, name: str) -> None:
    """Draw colours, with contour lines if the values differ."""
    drawn, colors = data.drawn(name), COLORS[name.split("_")[0]]
    colored = axis.tripcolor(triangles, drawn, shading="gouraud", cmap=colors)
    figure.colorbar(colored, ax=axis, label=data.quantities[name].axis, shrink=0.9)
    if np.ptp(drawn) > 1e-6 * np.abs(drawn).max():
        lines = axis.tricontour(triangles, drawn, _LINES, colors="black", linewidths=0.6)
        axis.clabel(lines, fontsize=8)
    axis.set_aspect("equal")
    axis.set_xlabel(data.quantities["x"].axis)
    axis.set_ylabel(data.quantities["y"].axis)


def triangulated(x: np.ndarray, y: np.ndarray) -> Triangulation:
    """Triangulate points of a face that need not be convex.

    The Delaunay triangulation fills the convex hull. Triangles at the boundary of a grid of points
    have an angle of 90° opposite to the boundary; triangles outside a concave boundary are much
    flatter, and are masked.
    """
    result = Triangulation(x, y)
    corners = np.stack([x, y], axis=1)[result.triangles]
    neighbors, hidden = result.neighbors.copy(), np.zeros(len(corners), dtype=bool)
    # side k of a triangle goes from corner k to the next; the remaining corner is opposite
    to_first, to_second = (corners - np.roll(corners, shift, axis=1) for shift in (1, -1))
    opposite = np.roll(_angles(-to_second, -to_first), -2, axis=1)
    while True:
        flat = ~hidden & np.any((neighbors == -1) & (opposite > _LARGEST_ANGLE), axis=1)
        if not flat.any():
            result.set_mask(hidden)
            return result
        hidden |= flat
        neighbors[np.isin(neighbors, np.flatnonzero(flat))] = -1


def _angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angles between vectors [degrees]."""
    cosine = (a * b).sum(axis=-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
