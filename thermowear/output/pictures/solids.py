"""Pictures of 3D bodies, clipped in the middle of the contact to show their interior."""

from __future__ import annotations

import numpy as np
import pyvista
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .windows import color_limits

PIXELS = (1400, 1100)
_CAMERA = (0.55, -1.0, 0.6)  # direction of the camera from the bodies
_MERGED = 1e-6  # of the bodies' size
_DEPTH_OFFSET = 1e-3
_EDGE_ANGLE = 40.0  # smallest angle between faces at a drawn edge [degrees]


def draw_solids(path, grid, fields: list[tuple[str, str]], note: str, y: float) -> None:
    """Draw one panel per field, side by side.

    Parameters
    ----------
    path : Path
    grid : pyvista.UnstructuredGrid
        Volume cells with the fields [mm].
    fields : list of tuple of str
        Names and colour maps.
    note : str
        Title, may be empty.
    y : float
        Position of the cutting plane; the part with smaller y is removed [mm].
    """
    parts = cut(grid, y)
    values = {name: np.concatenate([part[name] for part in parts]) for name, _ in fields}
    height = 5.2 * PIXELS[1] / PIXELS[0] + 0.5
    figure = Figure(figsize=(6.2 * len(fields), height), layout="constrained", dpi=150)
    for axis, (name, colors) in zip(
        figure.subplots(1, len(fields), squeeze=False)[0], fields, strict=True
    ):
        limits = color_limits(values[name])
        axis.imshow(render(parts, name, colors, limits), interpolation="antialiased")
        scale = ScalarMappable(Normalize(*limits), colors)
        over = np.nanmax(values[name]) > limits[1] * (1 + 1e-9)
        figure.colorbar(scale, ax=axis, label=name, shrink=0.8, extend="max" if over else "neither")
        axis.set_axis_off()
    figure.suptitle("; ".join(filter(None, [note, f"cut at y = {y:.4g} mm"])), fontsize=11)
    figure.savefig(path, bbox_inches="tight")


def cut(grid, y: float) -> list:
    """Surfaces of the bodies behind a plane normal to y, of body 2 and of body 1.

    Body 1 is offset slightly backwards, so that the material worn off body 1 is hidden.
    """
    size = float(np.ptp(grid.points, axis=0).max())
    surfaces = []
    for body in (2, 1):
        part = grid.extract_cells(np.flatnonzero(grid.cell_data["body"] == body))
        # merge coinciding samples of neighbouring cells, so that interior faces are no surface
        whole = part.clean(tolerance=_MERGED * size)
        surface = whole.clip(normal=(0.0, -1.0, 0.0), origin=(0.0, y, 0.0)).extract_surface()
        surface.points[:, 1] += (2 - body) * _DEPTH_OFFSET * size
        surfaces.append(surface)
    return surfaces


def render(surfaces: list, name: str, colors: str, limits) -> np.ndarray:
    """Render surfaces and their edges."""
    plotter = pyvista.Plotter(off_screen=True, window_size=list(PIXELS))
    plotter.set_background("white")  # type: ignore[arg-type]
    for surface in surfaces:
        plotter.add_mesh(
            surface, scalars=name, cmap=colors, clim=limits, show_scalar_bar=False, ambient=0.5
        )
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
