"""Sections of 2D bodies, coloured by a field (matplotlib)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import meshio
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.tri import Triangulation
from scipy.spatial import cKDTree

from ...results import FIELDS
from .panels import Extent, Limits, color_map, inside

_CORNERS = {"triangle": [[0, 1, 2]], "quad": [[0, 1, 2], [0, 2, 3]]}
_SAME = 1e-5  # tolerance for identical points, relative to the size of the bodies


@dataclass(frozen=True)
class BodySection:
    """Fields of 2D bodies on triangles; triangles of different cells share no points.

    Attributes
    ----------
    points, displacement : ndarray, shape (n, 2) [mm]
    triangles : ndarray of int, shape (m, 3)
    body : ndarray of int, shape (m,)
        Body of each triangle, 1 or 2.
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

    def draw(self, axis: Axes, name: str, limits: Limits, window: Extent) -> list[Artist]:
        """Draw a field in a window.

        Body 1 is drawn behind body 2, so that the material worn off body 1 is hidden.
        """
        axis.set(xlim=window[:2], ylim=window[2:])
        seen = inside(self.points, window, margin=1.0)[self.triangles].any(axis=1)
        drawn: list[Artist] = []
        for number in (1, 2):
            own = self.triangles[(self.body == number) & seen]
            colored = axis.tripcolor(
                Triangulation(self.points[:, 0], self.points[:, 1], own),
                self.fields[name],
                shading="gouraud",
                cmap=color_map(name),
                norm=Normalize(*limits),
                zorder=number,
            )
            edges = self.points[outline(self.points, own)]
            black = LineCollection(
                edges, colors="black", linewidths=0.9, snap=False, zorder=number + 0.5
            )
            drawn += [colored, axis.add_collection(black, autolim=False)]
        return drawn


def read_section(path: Path) -> BodySection:
    """Read the file of the fields of 2D bodies."""
    mesh = meshio.read(path)
    block, body = mesh.cells[0], mesh.cell_data["body"][0]
    corners = np.array(_CORNERS[block.type])
    return BodySection(
        points=1e3 * mesh.points[:, :2],
        displacement=1e3 * mesh.point_data["displacement_m"][:, :2],
        triangles=block.data[:, corners].reshape(-1, 3),
        body=np.repeat(body, len(corners)),
        fields={
            name: FIELDS[name].drawn(mesh.point_data[FIELDS[name].header])
            for name in ("temperature", "von_mises")
            if FIELDS[name].header in mesh.point_data
        },
    )


def outline(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Boundary edges of triangles, shape (k, 2).

    Triangles of different cells share no points, so that edges are identified by their midpoints.
    """
    edges = np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
    middles = points[edges].mean(axis=1)
    apart = _SAME * np.ptp(points, axis=0).max()
    nearest, _ = cKDTree(middles).query(middles, k=2)
    return edges[nearest[:, 1] > apart]
