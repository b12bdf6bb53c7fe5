"""The two bodies with temperature and stress; run as a process of its own.

pyvista renders the bodies off-screen, matplotlib puts scales and labels round them.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pyvista
from matplotlib.figure import Figure

_DEFORMED_PART = 0.06  # of the bodies' size: how far the largest displacement is drawn
_PIXELS = 1400  # of the longer side of a rendered picture
_BEHIND = 1e-3  # of the bodies' size: how far body 1 is set back


def draw_bodies(folder: Path) -> None:
    """``bodies.png`` (fields on the unloaded bodies) and ``deformed.png``."""
    grid = pyvista.read(folder / "fields.vtu")
    grid.points = grid.points * 1e3
    grid["von Mises stress [MPa]"] = grid["von_mises_Pa"] / 1e6
    fields = [("von Mises stress [MPa]", "viridis")]
    if "temperature_K" in grid.point_data:
        grid["temperature [°C]"] = grid["temperature_K"] - 273.15
        fields.insert(0, ("temperature [°C]", "inferno"))
    _draw(folder / "bodies.png", grid, fields, "")
    largest = float(np.linalg.norm(grid["displacement_m"], axis=1).max()) * 1e3
    size = float(np.ptp(grid.points, axis=0).max())
    factor = _round(_DEFORMED_PART * size / largest) if largest > 0 else 1.0
    grid.points = grid.points + factor * 1e3 * grid["displacement_m"]
    _draw(folder / "deformed.png", grid, fields, f"displacements magnified {factor:g} times")


def _draw(path: Path, grid, fields: list[tuple[str, str]], note: str) -> None:
    """One panel a field, side by side."""
    width, height = np.ptp(grid.points, axis=0)[:2]
    size = (5.2 * len(fields), 3.45 * height / width + (1.0 if note else 0.7))
    figure = Figure(figsize=size, layout="constrained", dpi=150)
    for axis, (name, colors) in zip(
        figure.subplots(1, len(fields), squeeze=False)[0], fields, strict=True
    ):
        limits = _limits(grid[name])
        picture, extent = _render(grid, name, colors, limits)
        axis.imshow(picture, extent=extent, interpolation="antialiased")
        scale = axis.imshow([limits], cmap=colors, extent=extent, visible=False)
        axis.set_xlim(extent[:2])
        axis.set_ylim(extent[2:])
        over = np.nanmax(grid[name]) > limits[1] * (1 + 1e-9)
        figure.colorbar(scale, ax=axis, label=name, shrink=0.8, extend="max" if over else "neither")
        axis.set_xlabel("x [mm]")
        axis.set_ylabel("y [mm]")
        axis.spines[["top", "right"]].set_visible(False)
    if note:
        figure.suptitle(note, fontsize=11)
    figure.savefig(path)


def _render(grid, name: str, colors: str, limits) -> tuple[np.ndarray, tuple[float, ...]]:
    """Picture of a plane grid, and the coordinates of its left, right, lower and upper edge.

    Body 1 lies a little behind body 2: what has been worn off it does not show.
    """
    x0, x1, y0, y1 = np.array(grid.bounds)[:4]
    margin = 0.02 * max(x1 - x0, y1 - y0)
    extent = (x0 - margin, x1 + margin, y0 - margin, y1 + margin)
    width, height = extent[1] - extent[0], extent[3] - extent[2]
    scale = _PIXELS / max(width, height)
    plotter = pyvista.Plotter(
        off_screen=True, window_size=(round(scale * width), round(scale * height))
    )
    plotter.set_background("white")  # type: ignore[arg-type]
    for body in np.unique(grid.cell_data["body"]):
        part = grid.extract_cells(np.flatnonzero(grid.cell_data["body"] == body))
        part.points[:, 2] = (body - 1) * _BEHIND * max(width, height)
        plotter.add_mesh(
            part, scalars=name, cmap=colors, clim=limits, lighting=False, show_scalar_bar=False
        )
        outline = part.extract_surface().clean(tolerance=1e-5 * max(width, height), absolute=True)
        edges = outline.extract_feature_edges(
            boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
        )
        plotter.add_mesh(edges, color="black", line_width=2, lighting=False)
    centre = ((extent[0] + extent[1]) / 2, (extent[2] + extent[3]) / 2)
    plotter.camera_position = [(*centre, max(width, height)), (*centre, 0.0), (0.0, 1.0, 0.0)]
    plotter.camera.parallel_projection = True
    plotter.camera.parallel_scale = height / 2
    picture = plotter.screenshot(None, return_img=True)
    plotter.close()
    return picture, extent


def _limits(values: np.ndarray) -> tuple[float, float]:
    """Colour range without the few samples beside singular edges."""
    low, high = float(values.min()), float(np.percentile(values, 99.5))
    return (low, high) if high > low else (low - 0.5, low + 0.5)


def _round(value: float) -> float:
    """The next smaller of 1, 2, 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(k for k in (1, 2, 5) if k * power <= value * (1 + 1e-12)))


if __name__ == "__main__":
    draw_bodies(Path(sys.argv[1]))
