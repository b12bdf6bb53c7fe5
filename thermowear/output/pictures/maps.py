"""Maps of a contact face of a 3D model, seen from above (matplotlib)."""

from __future__ import annotations

from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.tri import Triangulation
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from .. import tables
from ..files import name_at, picture
from .curves import coated_bodies, final_time, interface_panels, passing, worn_bodies
from .panels import MAP_STYLE, draw_colors, label_coordinates, panels, time_text

_LONGER_SIDE = 4.6  # longer side of the face [inches]
_LINES = 8
_ARROWS = 22
"""Number of arrows along each side of a face."""
_SMALL = 0.02
"""Part of the largest value from which arrows are drawn."""
_STATUS_COLORS = ListedColormap(["white", "tab:blue", "tab:orange"])
_LARGEST_ANGLE = 100.0
"""Largest angle of a long boundary triangle [degrees]; larger ones lie outside the face."""
_SHORT = 0.1
"""Length of a boundary edge relative to the face, up to which a triangle of any angle is drawn."""

_FEW = 6
"""Largest number of connected triangles that are no gap, but a place with uneven points."""
_GAP, _LONG, _ROUNDS = 0.8, 6.0, 4
"""Area of a triangle relative to that of its corners above which it lies across a gap; length of a
side relative to the root of a point's area, and number of triangles beside it that do so, too."""


def draw_interface_maps(folder: Path, contact: str = "") -> None:
    """Draw ``interface.png``: pressure, temperatures and shape over the face."""
    data = tables.read(folder / name_at("interface", None, contact))
    _draw(
        folder / picture("interface", contact),
        data,
        list(chain.from_iterable(interface_panels(data))),
    )


def draw_wear_maps(folder: Path, contact: str = "") -> None:
    """Draw ``wear.png``: wear depth of each body at the end of a transient analysis."""
    end = final_time(folder)
    if end is None:
        return
    data = tables.read(folder / name_at("interface", None, contact))
    names = worn_bodies(data)
    if names:
        _draw(folder / picture("wear", contact), data, names, f"wear after {time_text(end)}")


def draw_coating_maps(folder: Path, contact: str = "") -> None:
    """Draw ``coating.png``: what is left of the coatings at the end of a transient analysis."""
    end = final_time(folder)
    if end is None:
        return
    data = tables.read(folder / name_at("interface", None, contact))
    names = coated_bodies(data)
    if names:
        _draw(folder / picture("coating", contact), data, names, f"coating after {time_text(end)}")


def draw_friction_maps(folder: Path, contact: str = "") -> None:
    """Draw ``friction.png``: shear with its direction, slip, dissipated energy and status."""
    data = tables.read(folder / name_at("friction", None, contact))
    names = [name for name in ("shear", "slip", "dissipated") if np.any(data[name])]
    if "shear_x" not in data or not names:
        return
    triangles = triangulated(data.drawn("x"), data.drawn("y"))
    path = folder / picture("friction", contact)
    with _maps(path, triangles, len(names) + 1) as (_, axes):
        for axis, name in zip(axes.flat, names, strict=False):
            _map(axis, triangles, data, name)
            if name in ("shear", "slip"):
                _arrows(axis, triangles, data, name)
        _statuses(axes.flat[len(names)], triangles, data)


def draw_track_maps(folder: Path, contact: str = "") -> None:
    """Draw ``track.png``: wear depths of both bodies in the middle of the stroke."""
    moving, track = (
        tables.read(folder / name_at(stem, None, contact)) for stem in ("interface", "track")
    )
    names = [(data, name) for data, name in passing(moving, track) if data[name].any()]
    meshes = [triangulated(*(d.drawn(c) for c in ("x", "y", "weight"))) for d, _ in names]
    with _maps(folder / picture("track", contact), meshes[-1], len(names)) as (_, axes):
        for axis, triangles, (data, name) in zip(axes.flat, meshes, names, strict=False):
            _map(axis, triangles, data, name)


def _arrows(axis: Axes, triangles: Triangulation, data: tables.TableColumns, name: str) -> None:
    """Draw the directions of shear or slip on a grid of points, where it is not small."""
    x, y = (np.linspace(v.min(), v.max(), _ARROWS + 1) for v in (triangles.x, triangles.y))
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    places = np.column_stack([triangles.x, triangles.y])
    at = np.unique(np.linalg.norm(places - points[:, None], axis=2).argmin(axis=1))
    size = data[name][at]
    at, size = at[size > _SMALL * data[name].max()], size[size > _SMALL * data[name].max()]
    along = (data[f"{name}_{axis_}"][at] / size for axis_ in "xy")
    options = {"scale": 1.3 * _ARROWS, "width": 0.004, "pivot": "mid", "color": "black"}
    axis.quiver(triangles.x[at], triangles.y[at], *along, **options)


def _statuses(axis: Axes, triangles: Triangulation, data: tables.TableColumns) -> None:
    """Colour open, sticking and slipping parts of a face."""
    middle = data["status"][triangles.triangles].max(axis=1)
    colored = axis.tripcolor(triangles, middle, cmap=_STATUS_COLORS, vmin=-0.5, vmax=2.5)
    axis.set(
        xlim=(triangles.x.min(), triangles.x.max()), ylim=(triangles.y.min(), triangles.y.max())
    )
    bar = axis.figure.colorbar(colored, ax=axis, ticks=(0, 1, 2), shrink=0.9)
    bar.ax.set_yticklabels(("open", "stick", "slip"))
    label_coordinates(axis, data)


def _draw(path: Path, data: tables.TableColumns, names: list[str], title: str = "") -> None:
    """Draw a map of each quantity, two per row."""
    triangles = triangulated(*(data.drawn(name) for name in ("x", "y", "weight")))
    with _maps(path, triangles, len(names), title) as (figure, axes):
        for axis, name in zip(axes.flat, names, strict=False):
            _map(axis, triangles, data, name)
        if title:
            figure.suptitle(title, fontsize=11)


def _maps(path: Path, triangles: Triangulation, count: int, title: str = ""):
    """Panels for maps of a face, two per row."""
    ratio = np.clip(np.ptp(triangles.y) / np.ptp(triangles.x), 0.3, 2.5)
    size = (_LONGER_SIDE / max(1.0, ratio) + 2.2, _LONGER_SIDE * min(1.0, ratio) + 0.8)
    margin = (0.0, 0.3 if title else 0.0)
    options: dict[str, Any] = {"margin": margin, "style": MAP_STYLE, "crop": True}
    return panels(path, count, 2, size, **options)


def _map(axis: Axes, triangles: Triangulation, data: tables.TableColumns, name: str) -> None:
    """Draw colours, with contour lines if the values differ."""
    values = data.drawn(name)
    colored = draw_colors(axis, triangles, values, name)
    axis.figure.colorbar(colored, ax=axis, label=data.quantities[name].axis, shrink=0.9)
    if np.ptp(values) > 1e-6 * np.abs(values).max():
        lines = axis.tricontour(triangles, values, _LINES, colors="black", linewidths=0.6)
        axis.clabel(lines, fontsize=8)
    label_coordinates(axis, data)


def triangulated(x: np.ndarray, y: np.ndarray, weights: np.ndarray | None = None) -> Triangulation:
    """Triangulate points of a face that need not be convex, nor in one piece.

    The Delaunay triangulation fills the convex hull. Triangles at the boundary of a grid of points
    have an angle of 90° opposite to the boundary; triangles outside a concave boundary are much
    flatter, and are masked unless they are small, as between scattered points at a round edge.
    Triangles across a slot are larger than the area of their points.

    Parameters
    ----------
    x, y : ndarray, shape (n,)
    weights : ndarray, shape (n,), optional
        Area of each point.
    """
    result = Triangulation(x, y)
    corners = np.stack([x, y], axis=1)[result.triangles]
    neighbors, hidden = result.neighbors.copy(), np.zeros(len(corners), dtype=bool)
    if weights is not None:
        hidden |= _across_gaps(result, corners, weights)
        neighbors[np.isin(neighbors, np.flatnonzero(hidden))] = -1
    # side k of a triangle goes from corner k to the next; the remaining corner is opposite
    to_first, to_second = (corners - np.roll(corners, shift, axis=1) for shift in (1, -1))
    opposite = np.roll(_angles(-to_second, -to_first), -2, axis=1)
    is_long = np.linalg.norm(to_second, axis=2) > _SHORT * max(np.ptp(x), np.ptp(y))
    opposite[~is_long] = 0.0
    while True:
        flat = ~hidden & np.any((neighbors == -1) & (opposite > _LARGEST_ANGLE), axis=1)
        if not flat.any():
            result.set_mask(hidden)
            return result
        hidden |= flat
        neighbors[np.isin(neighbors, np.flatnonzero(flat))] = -1


def _across_gaps(triangles: Triangulation, corners: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Mask of triangles across gaps: larger than the area of their corners, or thin beside those.

    Areas are averaged over neighbours, as points of small pieces of facets have very small ones.
    """
    nodes = triangles.triangles
    for _ in range(2):
        of_each = np.repeat(weights[nodes].mean(axis=1), 3)
        weights = np.bincount(nodes.ravel(), of_each, len(weights))
        weights = weights / np.maximum(np.bincount(nodes.ravel(), minlength=len(weights)), 1)
    mean = weights[nodes].mean(axis=1)
    (a, b), (c, d) = (corners[:, 1:] - corners[:, :1]).transpose(1, 2, 0)
    found = np.abs(a * d - b * c) / 2 > _GAP * 3 * mean
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    across = (triangles.neighbors >= 0) & (lengths > _LONG * np.sqrt(mean)[:, None])
    for _ in range(_ROUNDS):
        found |= (across & found[triangles.neighbors]).any(axis=1)
    return found & (_group_sizes(triangles.neighbors, found) > _FEW)


def _group_sizes(neighbors: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Number of triangles in the group of each chosen one; groups are connected by sides."""
    beside = (neighbors >= 0) & chosen[neighbors] & chosen[:, None]
    pairs = np.nonzero(beside)[0], neighbors[beside]
    links = coo_array((np.ones(len(pairs[0])), pairs), shape=(len(chosen), len(chosen)))
    group = connected_components(links, directed=False)[1]
    return np.bincount(group)[group]


def _angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angles between vectors [degrees]."""
    cosine = (a * b).sum(axis=-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
