"""3D bodies, clipped in the middle of the contact to show their interior (pyvista)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyvista

from ...results import FIELDS
from ..tables import TableColumns
from .panels import (
    MAP_STYLE,
    SMALL_CONTACT,
    Limits,
    add_color_bar,
    color_limits,
    color_map,
    panels,
)

PIXELS = (1400, 1100)
_VIEW = (6.6, 5.2)  # largest width and height of a view [inches]
_CLOSE = 2.5  # width of a close-up relative to the contact
_TINY = 0.08  # size of a contact with a close-up relative to the bodies
_WHITE = 250  # least value of the channels of white
_MARGIN = 0.01  # relative to the size of a picture
_CAMERA = (0.55, -1.0, 0.6)  # direction of the camera from the bodies
_EDGE_ANGLE = 40.0  # smallest angle between faces at a drawn edge [degrees]
SHADING: dict[str, Any] = {
    "ambient": 0.6,
    "diffuse": 0.4,
    "smooth_shading": True,
    "split_sharp_edges": True,
    "feature_angle": _EDGE_ANGLE,
}
_MERGED = 1e-6  # of the bodies' size
_DEPTH_OFFSET = 1e-3
_ROUNDED = 0.05
"""Largest step of the positions of cuts, relative to the contact face."""


def read_grid(path: Path):
    """Read the file of the fields; points in mm, fields by name in the units of plots."""
    grid = pyvista.read(path)
    grid.points = 1e3 * grid.points
    for name in ("temperature", "von_mises"):
        if FIELDS[name].header in grid.point_data:
            grid[name] = FIELDS[name].drawn(grid[FIELDS[name].header])
    return grid


def middle(interface: TableColumns) -> float:
    """Middle of the contact face along y, where bodies are clipped, in round numbers [mm]."""
    y = interface.drawn("y")
    step = 10.0 ** np.floor(np.log10(_ROUNDED * np.ptp(y)))
    return float(step * np.round((y.min() + y.max()) / 2 / step)) + 0.0


def draw_solids(path: Path, grid, interface: TableColumns, title: str = "") -> None:
    """Draw one panel per field, side by side; close-ups of a small contact below.

    Parameters
    ----------
    path : Path
    grid : pyvista.UnstructuredGrid
        Cells with the fields, see `read_grid`. The part with smaller y than the contact's middle is
        removed.
    interface : TableColumns
        Contact points.
    title : str
        Remark on deformed bodies, of which there are no close-ups.
    """
    y = middle(interface)
    surfaces = clipped(grid, y)
    rows = [_fields_of(surfaces)]
    close = None if title else focus_on(interface, grid, _CLOSE, _TINY)
    if close is not None:
        rows.append(_fields_of(surfaces, close))
    cut = f"cut at y = {y:.4g} mm"
    draw_views(path, rows, "; ".join(filter(None, [title, cut])))


def _fields_of(surfaces: list, focus: list[float] | None = None) -> list[View]:
    """Views of all fields, of the whole bodies or within bounds [mm]."""
    views = []
    for name in ("temperature", "von_mises"):
        if name not in surfaces[0].point_data:
            continue
        values = np.concatenate([_within(surface, name, focus) for surface in surfaces])
        limits = color_limits(values)
        with rendering(focus=focus) as (plotter, picture):
            add_surfaces(plotter, surfaces, name, limits)
        pixels = cropped(picture[0])
        views.append(View(pixels, name, FIELDS[name].axis, limits, float(values.max())))
    return views


def _within(surface, name: str, focus: list[float] | None) -> np.ndarray:
    """Values of a surface within bounds [mm]."""
    if focus is None:
        return surface[name]
    low, high = np.reshape(focus, (3, 2)).T
    seen = np.all((surface.points >= low) & (surface.points <= high), axis=1)
    return surface[name][seen]


def focus_on(
    interface: TableColumns, bodies, wide: float, small: float = SMALL_CONTACT
) -> list[float] | None:
    """Bounds of a cube around the points in contact; None if they are not small [mm].

    Parameters
    ----------
    interface : TableColumns
    bodies : pyvista.DataSet
        Bodies, to which the size of the contact is compared.
    wide : float
        Size of the cube relative to that of the contact.
    small : float
        Size of a small contact relative to the bodies.
    """
    pressed = interface["pressure"] > 0
    if not pressed.any():
        return None
    points = np.column_stack([interface.drawn(axis)[pressed] for axis in "xyz"])
    low, high = points.min(axis=0), points.max(axis=0)
    size, middle_ = float((high - low).max()), (low + high) / 2
    if size > small * np.ptp(bodies.points, axis=0).max():
        return None
    reach = wide * size / 2
    bounds = np.column_stack([middle_ - reach, middle_ + reach])
    return [float(end) for end in bounds.ravel()]


class View(NamedTuple):
    """Rendered bodies and the colours of a quantity.

    Attributes
    ----------
    pixels : ndarray, shape (height, width, 3)
    name, label : str
        Quantity, and label of its colour bar.
    limits : tuple of float
    largest : float
        Largest value, see `add_color_bar`.
    title : str
    """

    pixels: np.ndarray
    name: str
    label: str
    limits: Limits
    largest: float
    title: str = ""


def draw_views(path: Path, rows: list[list[View]], title: str = "") -> None:
    """Draw rows of views with the same heights in each row."""
    width, height = _VIEW
    shapes = np.array([[v.pixels.shape[1] / v.pixels.shape[0] for v in row] for row in rows])
    widths = shapes.max(axis=0)
    tall = min(height, width / float(widths.max()))
    count, across = shapes.size, shapes.shape[1]
    size = (tall * float(widths.mean()) + 1.2, tall + 0.3)
    options: dict[str, Any] = {"style": MAP_STYLE, "crop": True, "width_ratios": widths}
    with panels(path, count, across, size, **options) as (figure, axes):
        for axis, view in zip(axes.flat, (v for row in rows for v in row), strict=True):
            axis.imshow(view.pixels, interpolation="antialiased")
            add_color_bar(axis, view.name, view.label, view.limits, view.largest)
            axis.set_axis_off()
            axis.set_title(view.title, fontsize=10)
        if title:
            figure.suptitle(title, fontsize=11)


def cropped(picture: np.ndarray) -> np.ndarray:
    """Picture without the white space around its content, except for a margin."""
    return picture[content(picture)]


def content(*pictures: np.ndarray) -> tuple[slice, slice]:
    """Rows and columns of the content of equally large pictures, with a margin."""
    drawn = np.any([np.any(picture < _WHITE, axis=2) for picture in pictures], axis=0)
    if not drawn.any():
        return np.s_[:, :]
    rows, columns = (np.flatnonzero(drawn.any(axis=axis)) for axis in (1, 0))
    margin = round(_MARGIN * max(pictures[0].shape))
    first, last = max(rows[0] - margin, 0), rows[-1] + margin + 1
    left, right = max(columns[0] - margin, 0), columns[-1] + margin + 1
    return np.s_[first:last, left:right]


def clipped(grid, y: float) -> list:
    """Surfaces of the bodies behind a plane normal to y, from the last body to the first.

    Each is offset slightly backwards from the one before, so that the material worn off body 1 of a
    pair is hidden.
    """
    size = float(np.ptp(grid.points, axis=0).max())
    surfaces = []
    bodies = np.unique(grid.cell_data["body"])[::-1]
    for number, body in enumerate(bodies):
        solid = grid.extract_cells(np.flatnonzero(grid.cell_data["body"] == body))
        # merge coinciding samples of neighbouring cells, so that interior faces are no surface
        merged = solid.clean(tolerance=_MERGED * size)
        surface = merged.clip(normal=(0.0, -1.0, 0.0), origin=(0.0, y, 0.0)).extract_surface()
        if surface.n_points:  # not wholly in front of the plane
            surface.points[:, 1] += number * _DEPTH_OFFSET * size
            surfaces.append(surface)
    return surfaces


def render(surfaces: list, name: str, limits: Limits) -> np.ndarray:
    """Render surfaces, smoothly shaded between their edges, as pixels."""
    with rendering() as (plotter, picture):
        add_surfaces(plotter, surfaces, name, limits)
    return picture[0]


def add_surfaces(plotter, surfaces: list, name: str, limits: Limits) -> None:
    """Add surfaces coloured by a quantity, and their edges."""
    options = {"cmap": color_map(name), "clim": limits, "show_scalar_bar": False, **SHADING}
    for surface in surfaces:
        plotter.add_mesh(surface, scalars=name, **options)
        add_edges(plotter, surface)


def add_edges(plotter, surface) -> None:
    """Add the sharp edges of a closed surface as black lines."""
    edges = surface.extract_feature_edges(
        feature_angle=_EDGE_ANGLE, boundary_edges=False, non_manifold_edges=False
    )
    if edges.n_points:
        plotter.add_mesh(edges, color="black", line_width=2, lighting=False)


def warm_up() -> None:
    """Load what the first picture needs, by drawing one for nobody."""
    with rendering() as (plotter, _):
        plotter.add_mesh(pyvista.Sphere())


@cache
def _plotter():
    """Plotter for all pictures: shaders are compiled for each window."""
    return pyvista.Plotter(off_screen=True, window_size=list(PIXELS))


@contextmanager
def rendering(direction=_CAMERA, focus=None) -> Iterator[tuple[Any, list[np.ndarray]]]:
    """Empty plotter with a white background and its picture, a list that is filled at the end.

    Parameters
    ----------
    direction : tuple of float
        Direction of the camera from the bodies.
    focus : tuple of float, optional
        Bounds of the part to be seen, by default all that is drawn [mm].
    """
    plotter = _plotter()
    plotter.suppress_rendering = True  # until all is there
    plotter.clear_actors()
    plotter.hide_axes()
    plotter.set_background("white")
    picture: list[np.ndarray] = []
    yield plotter, picture
    plotter.enable_parallel_projection()
    plotter.camera_position = [np.array(direction), np.zeros(3), (0.0, 0.0, 1.0)]
    if focus is None:
        plotter.add_axes(line_width=4)
    plotter.reset_camera(bounds=focus)
    plotter.camera.zoom(1.1)
    plotter.suppress_rendering = False
    plotter.render()
    picture.append(plotter.screenshot(None, return_img=True))
