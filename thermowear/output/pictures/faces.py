"""Contact face of body 2 of a 3D model: pressure, temperature, and the worn shape in relief."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista

from ...results import FIELDS
from ..tables import TableColumns
from .maps import triangulated
from .panels import Limits, color_limits, color_map
from .solids import (
    SHADING,
    View,
    add_edges,
    add_surfaces,
    cropped,
    draw_views,
    focus_on,
    rendering,
)

_ABOVE = (0.45, -1.0, 0.9)
"""Direction of the camera from the face."""
_RELIEF = 0.25  # height of the magnified shape relative to the face
_WIDE = 1.8  # width of the view of a small face relative to it
_LIFTED = 2e-3  # offset of the face from its body, relative to the face
_BODY = "lightgray"  # grey of bodies without a field


def draw_faces(path: Path, grid, interface: TableColumns) -> None:
    """Draw the contact face on body 2, without body 1, and the worn shape.

    Parameters
    ----------
    path : Path
    grid : pyvista.UnstructuredGrid
        Cells with the fields, see `read_grid`.
    interface : TableColumns
        Contact points.
    """
    face = contact_face(interface)
    body = grid.extract_cells(np.flatnonzero(grid.cell_data["body"] == 2))
    surface = body.clean(tolerance=1e-6 * body.length).extract_surface()
    focus = focus_on(interface, surface, _WIDE)
    views = [_pressure(face, surface, focus, interface)]
    if "temperature" in grid.point_data:
        views.append(_temperature(surface, focus))
    if np.ptp(face["shape"]) > 0.0:
        views.append(_shape(face, interface))
    draw_views(path, [views])


def contact_face(interface: TableColumns):
    """Contact points as a surface with pressure and shape in the units of plots [mm]."""
    x, y, z = map(interface.drawn, "xyz")
    triangles = triangulated(x, y).get_masked_triangles()
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


def _size(face) -> float:
    """Size of a face along x or y [mm]."""
    return float(np.ptp(face.points[:, :2], axis=0).max())


def _pressure(face, surface, focus, interface: TableColumns) -> View:
    """Pressure on the face of body 2."""
    limits = color_limits(face["pressure"])
    shown = face.copy()
    shown.points[:, 2] += _LIFTED * _size(face)
    with rendering(_ABOVE, focus) as (plotter, picture):
        plotter.add_mesh(surface, color=_BODY, **SHADING)
        add_edges(plotter, surface)
        _add_face(plotter, shown, "pressure", limits)
    label, largest = interface.quantities["pressure"].axis, float(face["pressure"].max())
    return View(cropped(picture[0]), "pressure", label, limits, largest, "body 2, body 1 removed")


def _temperature(surface, focus) -> View:
    """Temperature of body 2, its contact face included."""
    values = surface["temperature"]
    limits = color_limits(values)
    with rendering(_ABOVE, focus) as (plotter, picture):
        add_surfaces(plotter, [surface], "temperature", limits)
    label = FIELDS["temperature"].axis
    title = "body 2, body 1 removed"
    return View(cropped(picture[0]), "temperature", label, limits, float(values.max()), title)


def _shape(face, interface: TableColumns) -> View:
    """Worn shape over the unworn face, magnified."""
    factor = magnification(_size(face), 1e-3 * face["shape"])
    limits = float(face["shape"].min()), float(face["shape"].max())
    worn, base = face.copy(), face.copy()
    worn.points[:, 2] += factor * 1e-3 * face["shape"]
    base.points[:, 2] -= _LIFTED * _size(face)
    with rendering(_ABOVE) as (plotter, picture):
        plotter.add_mesh(base, color=_BODY, **SHADING)
        _add_face(plotter, worn, "shape", limits)
    label = interface.quantities["shape"].axis
    title = f"shape magnified {factor:g} times"
    return View(cropped(picture[0]), "shape", label, limits, limits[1], title)


def _add_face(plotter, face, name: str, limits: Limits) -> None:
    """Add a face coloured by a quantity, and its outline."""
    plotter.add_mesh(
        face, scalars=name, cmap=color_map(name), clim=limits, show_scalar_bar=False, **SHADING
    )
    outline = face.extract_feature_edges(
        feature_edges=False, non_manifold_edges=False, manifold_edges=False
    )
    plotter.add_mesh(outline, color="black", line_width=2, lighting=False)
