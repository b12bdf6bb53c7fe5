"""Temperature and stress of the two bodies; run in a separate process.

pyvista renders the bodies off-screen, matplotlib adds scales and labels.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pyvista
from matplotlib.figure import Figure

from ...results import FIELDS
from .. import tables
from .solids import draw_solids
from .windows import FLAT, Extent, around_contact, color_limits, is_small, whole, within

_DEFORMED_PART = 0.06  # largest displacement drawn, relative to the size of the bodies
_PIXELS = 1400  # longer side of a rendered picture
_DEPTH_OFFSET = 1e-3  # offset of body 1 away from the viewer, relative to the size of the bodies


def draw_bodies(folder: Path) -> None:
    """Draw ``bodies.png`` (fields on the undeformed bodies) and ``deformed.png``."""
    grid = pyvista.read(folder / "fields.vtu")
    grid.points = grid.points * 1e3
    fields = []
    for name, colors in (("temperature", "inferno"), ("von_mises", "viridis")):
        shown = FIELDS[name]
        if shown.header in grid.point_data:
            grid[shown.axis] = shown.drawn(grid[shown.header])
            fields.append((shown.axis, colors))
    in_space = pyvista.CellType.HEXAHEDRON in grid.celltypes
    if in_space:
        draw_solids(folder / "bodies.png", grid, fields, "", _middle(folder))
    else:
        table = tables.read(folder / "interface.csv")
        axes = tuple(table.quantities[name].axis for name in "xy")
        _draw(folder / "bodies.png", grid, fields, axes, contact=around_contact([table]))
    largest = float(np.linalg.norm(grid["displacement_m"], axis=1).max()) * 1e3
    size = float(np.ptp(grid.points, axis=0).max())
    factor = _round(_DEFORMED_PART * size / largest) if largest > 0 else 1.0
    grid.points = grid.points + factor * 1e3 * grid["displacement_m"]
    note = f"displacements magnified {factor:g} times"
    if in_space:
        draw_solids(folder / "deformed.png", grid, fields, note, _middle(folder))
    else:
        _draw(folder / "deformed.png", grid, fields, axes, note)


def _middle(folder: Path) -> float:
    """Middle of the contact face along y [mm]."""
    y = tables.read(folder / "interface.csv").drawn("y")
    return float((y.min() + y.max()) / 2)


def _draw(path: Path, grid, fields, axes: tuple[str, ...], note: str = "", contact=None) -> None:
    """Draw one panel per field side by side, and further panels around a small contact.

    The latter is beside the panel of a single field, else below the others.
    """
    windows = [whole(grid.points)]
    if contact is not None and is_small(contact, grid.points):
        windows.append(within(contact, grid.points))
    shapes = [(upper - lower) / (right - left) for left, right, lower, upper in windows]
    beside = len(fields) == 1
    rows, columns = (1, len(windows)) if beside else (len(windows), len(fields))
    tall = max(shapes) if beside else sum(shapes)
    flat_rows = sum(shape < FLAT for shape in shapes)
    size = (
        5.2 * columns,
        min(3.45 * tall, 6.0 * rows) + 0.7 * (rows + flat_rows) + (0.3 if note else 0.0),
    )
    figure = Figure(figsize=size, layout="constrained", dpi=150)
    ratios = None if beside else shapes
    panels = figure.subplots(rows, columns, squeeze=False, height_ratios=ratios)
    for row, extent in zip(panels.T if beside else panels, windows, strict=True):
        for axis, (name, colors) in zip(row, fields, strict=True):
            _panel(figure, axis, grid, name, colors, extent)
            axis.set_xlabel(axes[0])
            axis.set_ylabel(axes[1])
    if note:
        figure.suptitle(note, fontsize=11)
    figure.savefig(path, bbox_inches="tight")


def _panel(figure, axis, grid, name: str, colors: str, extent: Extent) -> None:
    """Draw a window of a field with its own colour range."""
    x, y = grid.points[:, 0], grid.points[:, 1]
    inside = (x >= extent[0]) & (x <= extent[1]) & (y >= extent[2]) & (y <= extent[3])
    limits = color_limits(grid[name][inside])
    picture = _render(grid, name, colors, limits, extent)
    axis.imshow(picture, extent=extent, interpolation="antialiased")
    scale = axis.imshow([limits], cmap=colors, extent=extent, visible=False)
    axis.set_xlim(extent[:2])
    axis.set_ylim(extent[2:])
    over = np.nanmax(grid[name][inside]) > limits[1] * (1 + 1e-9)
    flat = extent[3] - extent[2] < FLAT * (extent[1] - extent[0])
    figure.colorbar(
        scale,
        ax=axis,
        label=name,
        shrink=0.8,
        extend="max" if over else "neither",
        location="bottom" if flat else "right",
    )
    axis.spines[["top", "right"]].set_visible(False)


def _render(grid, name: str, colors: str, limits, extent: Extent) -> np.ndarray:
    """Render a plane grid in a window.

    Body 1 is offset slightly behind body 2, so that the material worn off body 1 is hidden.
    """
    width, height = extent[1] - extent[0], extent[3] - extent[2]
    scale = _PIXELS / max(width, height)
    plotter = pyvista.Plotter(
        off_screen=True, window_size=(round(scale * width), round(scale * height))
    )
    plotter.set_background("white")  # type: ignore[arg-type]
    for body in np.unique(grid.cell_data["body"]):
        part = grid.extract_cells(np.flatnonzero(grid.cell_data["body"] == body))
        part.points[:, 2] = (body - 1) * _DEPTH_OFFSET * max(width, height)
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
    return picture


def _round(value: float) -> float:
    """Round down to 1, 2 or 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(k for k in (1, 2, 5) if k * power <= value * (1 + 1e-12)))


if __name__ == "__main__":
    draw_bodies(Path(sys.argv[1]))
