"""3D bodies, clipped in the middle of the contact to show their interior (pyvista)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyvista

from ...results import FIELDS
from ..tables import TableColumns
from .panels import MAP_STYLE, Limits, add_color_bar, color_limits, color_map, panels

PIXELS = (1400, 1100)
_CAMERA = (0.55, -1.0, 0.6)  # direction of the camera from the bodies
_MERGED = 1e-6  # of the bodies' size
_DEPTH_OFFSET = 1e-3
_EDGE_ANGLE = 40.0  # smallest angle between faces at a drawn edge [degrees]


def read_grid(path: Path):
    """Read the file of the fields; points in mm, fields by name in the units of plots."""
    grid = pyvista.read(path)
    grid.points = 1e3 * grid.points
    for name in ("temperature", "von_mises"):
        if FIELDS[name].header in grid.point_data:
            grid[name] = FIELDS[name].drawn(grid[FIELDS[name].header])
    return grid


def middle(interface: TableColumns) -> float:
    """Middle of the contact face along y, where bodies are clipped [mm]."""
    y = interface.drawn("y")
    return float((y.min() + y.max()) / 2)


def draw_solids(path: Path, grid, y: float, title: str = "") -> None:
    """Draw one panel per field, side by side.

    Parameters
    ----------
    path : Path
    grid : pyvista.UnstructuredGrid
        Cells with the fields, see `read_grid`.
    y : float
        Position of the cutting plane; the part with smaller y is removed [mm].
    title : str
    """
    surfaces = clipped(grid, y)
    names = [name for name in ("temperature", "von_mises") if name in grid.point_data]
    size = (6.2, 5.2 * PIXELS[1] / PIXELS[0] + 0.5)
    options: dict[str, Any] = {"style": MAP_STYLE, "crop": True}
    with panels(path, len(names), len(names), size, **options) as (figure, axes):
        for axis, name in zip(axes.flat, names, strict=True):
            values = np.concatenate([surface[name] for surface in surfaces])
            limits = color_limits(values)
            axis.imshow(render(surfaces, name, limits), interpolation="antialiased")
            add_color_bar(axis, name, FIELDS[name].axis, limits, values.max())
            axis.set_axis_off()
        figure.suptitle("; ".join(filter(None, [title, f"cut at y = {y:.4g} mm"])), fontsize=11)


def clipped(grid, y: float) -> list:
    """Surfaces of the bodies behind a plane normal to y, of body 2 and of body 1.

    Body 1 is offset slightly backwards, so that the material worn off body 1 is hidden.
    """
    size = float(np.ptp(grid.points, axis=0).max())
    surfaces = []
    for body in (2, 1):
        solid = grid.extract_cells(np.flatnonzero(grid.cell_data["body"] == body))
        # merge coinciding samples of neighbouring cells, so that interior faces are no surface
        merged = solid.clean(tolerance=_MERGED * size)
        surface = merged.clip(normal=(0.0, -1.0, 0.0), origin=(0.0, y, 0.0)).extract_surface()
        surface.points[:, 1] += (2 - body) * _DEPTH_OFFSET * size
        surfaces.append(surface)
    return surfaces


def render(surfaces: list, name: str, limits: Limits) -> np.ndarray:
    """Render surfaces and their edges as pixels."""
    plotter = pyvista.Plotter(off_screen=True, window_size=list(PIXELS))
    plotter.set_background("white")  # type: ignore[arg-type]
    options = {"cmap": color_map(name), "clim": limits, "show_scalar_bar": False, "ambient": 0.5}
    for surface in surfaces:
        plotter.add_mesh(surface, scalars=name, **options)
        edges = surface.extract_feature_edges(
            feature_angle=_EDGE_ANGLE, boundary_edges=False, non_manifold_edges=False
        )
        if edges.n_points:
            plotter.add_mesh(edges, color="black", line_width=2, lighting=False)
    plotter.enable_parallel_projection()  # type: ignore[call-arg]
    plotter.camera_position = [np.array(_CAMERA), np.zeros(3), (0.0, 0.0, 1.0)]
    plotter.add_axes(line_width=4)  # type: ignore[call-arg]
    plotter.reset_camera()  # type: ignore[call-arg]
    plotter.camera.zoom(1.1)
    picture = plotter.screenshot(None, return_img=True)
    plotter.close()
    return picture
