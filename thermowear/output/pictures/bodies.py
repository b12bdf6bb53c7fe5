"""Temperature and stress of the bodies: sections here, bodies in space by pyvista."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import meshio
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.tri import Triangulation
from scipy.spatial import cKDTree

from ...results import FIELDS
from .. import tables
from ..files import bodies_of, contacts_of, name_at, picture, read_summary
from .kinds import is_surface
from .panels import (
    MAP_STYLE,
    Extent,
    Limits,
    add_color_bar,
    color_limits,
    contact_window,
    draw_colors,
    inside,
    label_coordinates,
    panels,
    proportion,
    whole,
)

_CORNERS = {"triangle": [[0, 1, 2]], "quad": [[0, 1, 2], [0, 2, 3]]}
_SAME = 1e-5  # tolerance for identical points, relative to the size of the bodies
_DEFORMED_SIZE = 0.06  # largest displacement drawn, relative to the size of the bodies
_FLAT = 0.55
"""Height over width of a window below which its colour bar is placed below it."""


@dataclass(frozen=True)
class BodySection:
    """Fields of 2D bodies on triangles; triangles of different cells share no points.

    Attributes
    ----------
    points, displacement : ndarray, shape (n, 2) [mm]
    triangles : ndarray of int, shape (m, 3)
    body : ndarray of int, shape (m,)
        Number of the body of each triangle, from 1.
    fields : dict of str to ndarray, shape (n,)
        Temperature, if there is one, and stress in the units of plots.
    """

    points: np.ndarray
    displacement: np.ndarray
    triangles: np.ndarray
    body: np.ndarray
    fields: dict[str, np.ndarray]

    def displaced(self, factor: float = 1.0) -> BodySection:
        """Deformed section, with magnified displacements."""
        return replace(self, points=self.points + factor * self.displacement)

    @cached_property
    def outlines(self) -> dict[int, np.ndarray]:
        """Boundary edges of each body, shape (k, 2)."""
        each = np.unique(self.body)
        return {n: outline(self.points, self.triangles[self.body == n]) for n in each}

    def draw(self, axis: Axes, name: str, limits: Limits, window: Extent) -> list[Artist]:
        """Draw a field in a window.

        Body 1 is drawn behind body 2, so that the material worn off body 1 is hidden.
        """
        axis.set(xlim=window[:2], ylim=window[2:])
        seen = inside(self.points, window, margin=1.0)[self.triangles].any(axis=1)
        drawn: list[Artist] = []
        for number, edges in self.outlines.items():
            x, y = self.points.T
            own = Triangulation(x, y, self.triangles[(self.body == number) & seen])
            colored = draw_colors(axis, own, self.fields[name], name, limits, zorder=number)
            style = {"colors": "black", "linewidths": 0.9, "snap": False}
            black = LineCollection(self.points[edges], zorder=number + 0.5, **style)
            drawn += [colored, axis.add_collection(black, autolim=False)]
        return drawn


def read_section(path: Path) -> BodySection:
    """Read the file of the fields of 2D bodies."""
    mesh = meshio.vtu.read(path)  # meshio.read would end the program for a damaged file
    corners = [np.array(_CORNERS[block.type]) for block in mesh.cells]
    divided = [
        block.data[:, of].reshape(-1, 3) for block, of in zip(mesh.cells, corners, strict=True)
    ]
    bodies = zip(mesh.cell_data["body"], corners, strict=True)
    return BodySection(
        points=1e3 * mesh.points[:, :2],
        displacement=1e3 * mesh.point_data["displacement_m"][:, :2],
        triangles=np.concatenate(divided),
        body=np.concatenate([np.repeat(body, len(of)) for body, of in bodies]),
        fields={
            name: FIELDS[name].drawn(mesh.point_data[FIELDS[name].header])
            for name in ("temperature", "von_mises")
            if FIELDS[name].header in mesh.point_data
        },
    )


def outline(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Boundary edges of triangles, shape (k, 2).

    Triangles of different cells share no points, so that edges are identified by their midpoints.
    Most edges are inside a cell, where two triangles share both points, and are not looked for.
    """
    edges = np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
    names = edges.min(axis=1) * len(points) + edges.max(axis=1)
    _, first, count = np.unique(names, return_index=True, return_counts=True)
    edges = edges[np.sort(first[count == 1])]
    middles = points[edges].mean(axis=1)
    apart = _SAME * np.ptp(points, axis=0).max()
    nearest, _ = cKDTree(middles).query(middles, k=2)
    return edges[nearest[:, 1] > apart]


def draw_bodies(folder: Path) -> None:
    """Draw ``bodies.png`` (fields on the undeformed bodies) and ``deformed.png``.

    In space also ``faces.png``, one for each contact of several bodies.
    """
    (_draw_solids if is_surface(folder) else _draw_sections)(folder)


def _draw_sections(folder: Path) -> None:
    """Draw sections of 2D bodies, with a further window around a small contact."""
    interfaces = _interfaces(folder)
    interface, section = interfaces[0], read_section(folder / "fields.vtu")
    contact = contact_window(interfaces, section.points)
    windows = [whole(section.points), *([contact] if contact else [])]
    _draw_windows(folder / "bodies.png", section, interface, windows)
    factor = _magnification(section.points, section.displacement)
    section = section.displaced(factor)
    title = _title(factor)
    _draw_windows(folder / "deformed.png", section, interface, [whole(section.points)], title)


def _interfaces(folder: Path) -> list[tables.TableColumns]:
    """Contact points at the end, by contact."""
    files = (name_at("interface", None, contact) for contact in contacts_of(folder))
    return [tables.read(folder / file) for file in files]


def _draw_windows(
    path: Path,
    section: BodySection,
    interface: tables.TableColumns,
    windows: list[Extent],
    title: str = "",
) -> None:
    """Draw one panel per field side by side; further windows below, or beside a single field."""
    shapes = [proportion(window) for window in windows]
    is_single = len(section.fields) == 1
    rows, columns = (1, len(windows)) if is_single else (len(windows), len(section.fields))
    height = max(shapes) if is_single else sum(shapes)
    bars_below = sum(shape < _FLAT for shape in shapes)
    size = (5.2, min(3.45 * height / rows, 6.0))
    margin = (0.0, 0.7 * (rows + bars_below) + (0.3 if title else 0.0))
    options: dict[str, Any] = {"margin": margin, "style": MAP_STYLE, "crop": True}
    options["height_ratios"] = None if is_single else shapes
    with panels(path, rows * columns, columns, size, **options) as (figure, axes):
        for row, window in zip(axes.T if is_single else axes, windows, strict=True):
            place = "bottom" if proportion(window) < _FLAT else "right"
            for axis, (name, values) in zip(row, section.fields.items(), strict=True):
                seen = values[inside(section.points, window)]
                limits = color_limits(seen)
                section.draw(axis, name, limits, window)
                label_coordinates(axis, interface)
                label = FIELDS[name].axis
                add_color_bar(axis, name, label, limits, seen.max(), location=place)
        if title:
            figure.suptitle(title, fontsize=11)


def _draw_solids(folder: Path) -> None:
    """Draw 3D bodies, clipped in the middle of the contact."""
    from .in_space.faces import draw_faces
    from .in_space.solids import clipped, close_up, displaced, draw_solids, middle, read_grid

    interfaces, grid = _interfaces(folder), read_grid(folder / "fields.vtu")
    y = middle(interfaces[0])
    cut = clipped(grid, y)
    draw_solids(folder / "bodies.png", cut, y, close=close_up(interfaces[0], grid))
    factor = _magnification(grid.points, 1e3 * grid["displacement_m"])
    draw_solids(folder / "deformed.png", displaced(cut, factor), y, _title(factor))
    for contact, face in zip(contacts_of(folder), interfaces, strict=True):
        draw_faces(folder / picture("faces", contact), grid, face, _seen(folder, contact))


def _seen(folder: Path, contact: str):
    """Body that bears the face of a contact in its picture: the second one."""
    from .in_space.faces import Seen

    first, second = bodies_of(folder, contact)
    if not contact:
        return Seen(2, f"{second}, {first} removed")
    number = 1 + list(read_summary(folder)["bodies"]).index(second)
    return Seen(number, f"{second}, seen from {first}")


def _title(factor: float) -> str:
    return f"displacements magnified {factor:g} times"


def _magnification(points: np.ndarray, displacement: np.ndarray) -> float:
    """Factor of the drawn displacements: 1, 2 or 5 times a power of ten."""
    largest = float(np.linalg.norm(displacement, axis=1).max())
    if largest == 0.0:
        return 1.0
    value = _DEFORMED_SIZE * float(np.ptp(points, axis=0).max()) / largest
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(k for k in (1, 2, 5) if k * power <= value * (1 + 1e-12)))
