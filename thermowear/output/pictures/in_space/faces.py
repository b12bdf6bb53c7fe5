"""Contact face of a body in space: pressure, temperature, and the worn shape in relief.

It lies on body 2 of a pair, and on the second body of a contact of several ones.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista

from ....results import FIELDS
from ...tables import TableColumns
from ..maps import triangulated
from ..panels import Limits, color_limits, color_map, cropped
from .solids import (
    GREY,
    SHADING,
    Solid,
    View,
    add_grey,
    add_lines,
    add_solid,
    draw_views,
    focus_on,
    merged,
    rendering,
    solid_of,
)

_ABOVE = (0.45, -1.0, 0.9)
"""Direction of the camera from the face."""
_RELIEF = 0.25  # height of the magnified shape relative to the face
_WIDE = 1.8  # width of the view of a small face relative to it
_SOME = 200  # points of a face that tell its side
_LIFTED = 2e-3  # offset of the face from its body, relative to the face


class Seen(NamedTuple):
    """Body with the face that is drawn.

    Attributes
    ----------
    number : int
        Of the body, from 1.
    title : str
    """

    number: int
    title: str


def draw_faces(path: Path, grid, interface: TableColumns, seen: Seen) -> None:
    """Draw the contact face on one body, without all others, and the worn shape.

    Parameters
    ----------
    path : Path
    grid : pyvista.UnstructuredGrid
        Cells with the fields, see `read_grid`.
    interface : TableColumns
        Contact points.
    seen : Seen
    """
    face = contact_face(interface)
    body = grid.extract_cells(np.flatnonzero(grid.cell_data["body"] == seen.number))
    surface = merged(body).extract_surface()
    focus = focus_on(interface, surface, _WIDE)
    outwards, bearer = _outwards(face, surface), solid_of([surface])
    views = [_pressure(face, bearer, focus, interface, outwards, seen.title)]
    if "temperature" in grid.point_data:
        views.append(_temperature(bearer, focus, outwards, seen.title))
    if np.ptp(face["shape"]) > 0.0:
        views.append(_shape(face, interface, outwards))
    draw_views(path, [views[:2], views[2:]])


def contact_face(interface: TableColumns):
    """Contact points as a surface with pressure and shape in the units of plots [mm]."""
    x, y, z = map(interface.drawn, "xyz")
    triangles = triangulated(x, y, interface.drawn("weight")).get_masked_triangles()
    corners = np.column_stack([np.full(len(triangles), 3), triangles])
    face = pyvista.PolyData(np.column_stack([x, y, z]), corners.ravel())
    for name in ("pressure", "shape"):
        face[name] = interface.drawn(name)
    return face


def magnification(size: float, heights: np.ndarray) -> float:
    """Magnification of the heights of a face of a size, in the same unit: a round number."""
    wanted = _RELIEF * size / float(np.ptp(heights))
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(k for k in (1, 2, 5) if k * power <= wanted * (1 + 1e-12)))


def _outwards(face, surface) -> float:
    """Direction along z that a face of a body looks to: the sign of its normal, 1 or -1."""
    oriented = surface.compute_normals(point_normals=False, auto_orient_normals=True)
    some = face.points[:: max(1, face.n_points // _SOME)]
    at_face = oriented.find_closest_cell(some)
    return 1.0 if oriented.cell_data["Normals"][at_face, 2].mean() >= 0.0 else -1.0


def _size(face) -> float:
    """Size of a face along x or y [mm]."""
    return float(np.ptp(face.points[:, :2], axis=0).max())


def _camera(outwards: float) -> tuple[float, float, float]:
    """Direction of the camera from a face that looks upwards (1) or downwards (-1)."""
    x, y, z = _ABOVE
    return x, y, outwards * z


def _pressure(
    face, body: Solid, focus, interface: TableColumns, outwards: float, title: str
) -> View:
    """Pressure on the face of a body."""
    limits = color_limits(face["pressure"])
    shown = face.copy()
    shown.points[:, 2] += outwards * _LIFTED * _size(face)
    with rendering(_camera(outwards), focus) as (plotter, picture):
        add_grey(plotter, body)
        _add_face(plotter, shown, "pressure", limits)
    label, largest = interface.quantities["pressure"].axis, float(face["pressure"].max())
    return View(cropped(picture[0]), "pressure", label, limits, largest, title)


def _temperature(body: Solid, focus, outwards: float, title: str) -> View:
    """Temperature of a body, its contact face included."""
    values = body.surface["temperature"]
    limits = color_limits(values)
    with rendering(_camera(outwards), focus) as (plotter, picture):
        add_solid(plotter, body, "temperature", limits)
    label = FIELDS["temperature"].axis
    return View(cropped(picture[0]), "temperature", label, limits, float(values.max()), title)


def _shape(face, interface: TableColumns, outwards: float) -> View:
    """Worn shape over the unworn face, magnified."""
    factor = magnification(_size(face), 1e-3 * face["shape"])
    limits = float(face["shape"].min()), float(face["shape"].max())
    worn, base = face.copy(), face.copy()
    worn.points[:, 2] += outwards * factor * 1e-3 * face["shape"]
    base.points[:, 2] -= outwards * _LIFTED * _size(face)
    with rendering(_camera(outwards)) as (plotter, picture):
        plotter.add_mesh(base, color=GREY, **SHADING)
        _add_face(plotter, worn, "shape", limits)
    label = interface.quantities["shape"].axis
    title = f"worn shape of the contact face, magnified {factor:g} times"
    return View(cropped(picture[0]), "shape", label, limits, limits[1], title)


def _add_face(plotter, face, name: str, limits: Limits) -> None:
    """Add a face coloured by a quantity, and its outline."""
    plotter.add_mesh(
        face, scalars=name, cmap=color_map(name), clim=limits, show_scalar_bar=False, **SHADING
    )
    outline = face.extract_feature_edges(
        feature_edges=False, non_manifold_edges=False, manifold_edges=False
    )
    add_lines(plotter, outline)
