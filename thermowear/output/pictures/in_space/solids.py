"""3D bodies, clipped in the middle of the contact to show their inside.

VTK's own merging searches in even buckets: on graded meshes, most of whose points are in few of
them, it takes twenty times as long as a search tree.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
import pyvista
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ....results import FIELDS
from ...tables import TableColumns
from ..panels import (
    MAP_STYLE,
    SMALL_CONTACT,
    Limits,
    add_color_bar,
    color_limits,
    color_map,
    cropped,
    panels,
)

_COINCIDENT = 1e-6  # distance of coinciding points, relative to the size of the body


def merged(grid):
    """Unstructured grid whose coinciding points are one, with the means of their values."""
    n = grid.n_points
    pairs = cKDTree(grid.points).query_pairs(_COINCIDENT * grid.length, output_type="ndarray")
    one, other = pairs.T
    linked = sp.coo_matrix((np.ones(len(one), dtype=bool), (one, other)), (n, n))
    count, number = sp.csgraph.connected_components(linked, directed=False)
    shares = 1.0 / np.bincount(number)[number]
    mean = sp.csr_matrix((shares, (number, np.arange(n))), (count, n))
    cells, is_point = grid.cells.copy(), np.ones(len(grid.cells), dtype=bool)
    is_point[grid.offset[:-1] + np.arange(grid.n_cells)] = False  # the number of points of a cell
    cells[is_point] = number[cells[is_point]]
    result = pyvista.UnstructuredGrid(cells, grid.celltypes, mean @ grid.points)
    for name, values in grid.point_data.items():
        result.point_data[name] = mean @ values
    for name, values in grid.cell_data.items():
        result.cell_data[name] = values
    return result


_VIEW = (5.0, 4.0)  # largest width and height of a view [inches]


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
    """Draw rows of views with the same heights in each row; the last one may be shorter."""
    width, height = _VIEW
    across = max(map(len, rows))
    views = [view for row in rows for view in row]
    shapes = [view.pixels.shape[1] / view.pixels.shape[0] for view in views]
    widths = [max(shapes[k::across]) for k in range(across)]
    tall = min(height, width / max(widths))
    size = (tall * float(np.mean(widths)) + 1.2, tall + 0.3)
    options: dict[str, Any] = {"style": MAP_STYLE, "crop": True, "width_ratios": widths}
    with panels(path, len(views), across, size, **options) as (figure, axes):
        for axis, view in zip(axes.flat, views, strict=False):
            axis.imshow(view.pixels, interpolation="antialiased")
            add_color_bar(axis, view.name, view.label, view.limits, view.largest)
            axis.set_axis_off()
            axis.set_title(view.title, fontsize=10)
        if title:
            figure.suptitle(title, fontsize=11)


PIXELS = (1600, 1257)
"""Rendered pixels, half as many again as are shown in each direction: this smooths the edges."""
LINE = 2.7  # width of a line [pixels]
_CLOSE = 2.5  # width of a close-up relative to the contact
_TINY = 0.08  # size of a contact with a close-up relative to the bodies
_CAMERA = (0.55, -1.0, 0.6)  # direction of the camera from the bodies
_EDGE_ANGLE = 40.0  # smallest angle between faces at a drawn edge [degrees]
SHADING: dict[str, Any] = {
    "ambient": 0.6,
    "diffuse": 0.4,
    "smooth_shading": True,
}
GREY = "lightgray"  # of bodies without a field
_DEPTH_OFFSET = 1e-3
_BEHIND = 1e-5
"""Distance of the cut from its plane, relative to the body.

Edges of cells that end in the plane, but for rounding, would be cut into coinciding points, and the
normals of triangles without area are arbitrary.
"""
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


def draw_solids(path: Path, surfaces: list, y: float, title: str = "", close=None) -> None:
    """Draw one panel per field, side by side.

    Parameters
    ----------
    path : Path
    surfaces : list of pyvista.PolyData
        Bodies with their fields, see `clipped`.
    y : float
        Position of the cut [mm].
    title : str
        Remark on deformed bodies.
    close : list of float, optional
        Bounds of a close-up of the contact, drawn below, see `close_up`.
    """
    bodies = solid_of(surfaces)
    rows = [_fields_of(bodies), *([_fields_of(bodies, close)] if close else [])]
    draw_views(path, rows, "; ".join(filter(None, [title, f"cut at y = {y:.4g} mm"])))


def close_up(interface: TableColumns, bodies) -> list[float] | None:
    """Bounds of a close-up of a contact that is small relative to the bodies; None if it is not."""
    return focus_on(interface, bodies, _CLOSE, _TINY)


def displaced(surfaces: list, factor: float) -> list:
    """Surfaces with magnified displacements."""
    moved = [surface.copy() for surface in surfaces]
    for surface in moved:
        surface.points = surface.points + factor * 1e3 * surface["displacement_m"]
    return moved


def _fields_of(bodies: Solid, focus: list[float] | None = None) -> list[View]:
    """Views of all fields, of the whole bodies or within bounds [mm]."""
    views = []
    for name in ("temperature", "von_mises"):
        if name not in bodies.surface.point_data:
            continue
        values = _within(bodies.surface, name, focus)
        limits = color_limits(values)
        with rendering(focus=focus) as (plotter, picture):
            add_solid(plotter, bodies, name, limits)
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
        whole = merged(solid)
        origin = (0.0, y + _BEHIND * whole.length, 0.0)
        surface = whole.clip(normal=(0.0, -1.0, 0.0), origin=origin).extract_surface()
        if surface.n_points:  # not wholly in front of the plane
            surface.points[:, 1] += number * _DEPTH_OFFSET * size
            surfaces.append(surface)
    return surfaces


class Solid(NamedTuple):
    """Bodies to be rendered.

    Attributes
    ----------
    surface : pyvista.PolyData
        Surfaces of all bodies, with normals for smooth shading between their edges.
    edges : pyvista.PolyData
        Sharp edges.
    """

    surface: Any
    edges: Any


def solid_of(surfaces: list) -> Solid:
    """Prepare closed surfaces for any number of scenes."""
    whole = surfaces[0].append_polydata(*surfaces[1:]) if len(surfaces) > 1 else surfaces[0]
    edges = whole.extract_feature_edges(
        feature_angle=_EDGE_ANGLE, boundary_edges=False, non_manifold_edges=False
    )
    surface = whole.compute_normals(
        cell_normals=False, split_vertices=True, feature_angle=_EDGE_ANGLE
    )
    return Solid(surface, edges)


def render(surfaces: list, name: str, limits: Limits) -> np.ndarray:
    """Render surfaces coloured by a quantity as pixels."""
    with rendering() as (plotter, picture):
        add_solid(plotter, solid_of(surfaces), name, limits)
    return picture[0]


def add_solid(plotter, solid: Solid, name: str, limits: Limits) -> None:
    """Add bodies coloured by a quantity, and their edges."""
    options = {"cmap": color_map(name), "clim": limits, "show_scalar_bar": False, **SHADING}
    plotter.add_mesh(solid.surface, scalars=name, **options)
    add_lines(plotter, solid.edges)


def add_grey(plotter, solid: Solid) -> None:
    """Add bodies in grey, and their edges."""
    plotter.add_mesh(solid.surface, color=GREY, **SHADING)
    add_lines(plotter, solid.edges)


def add_lines(plotter, lines) -> None:
    """Add black lines, if there are any."""
    if lines.n_points:
        plotter.add_mesh(lines, color="black", line_width=LINE, lighting=False)


def warm_up() -> None:
    """Load what the first picture needs, by drawing one for nobody."""
    with rendering() as (plotter, picture):
        plotter.add_mesh(pyvista.Sphere())
    view = View(cropped(picture[0]), "pressure", "", (0.0, 1.0), 1.0)
    with TemporaryDirectory() as folder:
        draw_views(Path(folder) / "warm-up.png", [[view]])


@cache
def _plotter():
    """Plotter for all pictures: shaders are compiled for each window.

    Multisampling costs three times as much as all else, and hardly shows at this resolution.
    """
    plotter = pyvista.Plotter(off_screen=True, window_size=list(PIXELS))
    plotter.render_window.SetMultiSamples(0)
    return plotter


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
        plotter.add_axes(line_width=5)
    plotter.reset_camera(bounds=focus)
    plotter.camera.zoom(1.1)
    plotter.suppress_rendering = False
    plotter.render()
    picture.append(np.array(plotter.screenshot(None, return_img=True), order="C"))
