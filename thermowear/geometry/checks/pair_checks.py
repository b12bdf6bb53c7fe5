"""Checks of the relative position of two bodies of a mesh file.

Only impossible elastic contacts are rejected: bodies that overlap or are compressed by a large part
of their own size, that lie on the wrong side of each other, or too far apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...case.tables.materials import SQUEEZED, check_pressure, softest
from ...errors import CaseError, note
from ..mesh.mixed import AnyMesh, block_with
from ..mesh.nodes import shape_functions
from ..mesh.tagged import TaggedMesh
from .mesh_checks import (
    depth,
    length,
    note_polygons,
    note_pressure,
    note_size,
    points_of,
    whole_bodies,
)
from .solid_pairs import area_vector, compared_solids

if TYPE_CHECKING:
    from ...case.tables.geometry import Geometry
    from ...case.tables.schema import Case

_PIECES = 4
"""Number of straight segments per curved edge, times its order."""
_FACING = 0.05
"""Least cosine between a normal and the load direction of a segment that faces the other body."""
MUCH = 0.02
"""Compression relative to the height of a body above which a note is issued."""
_APART = 0.01
"""Gap relative to the height of a body above which a note is issued."""
_PLANE = 1e-9
"""Largest excess of the area of a plane face over that of its projection, relative to it."""
_AT_ONCE = 2000
"""Number of points at which faces are compared together."""
_AS_THEY_ARE = np.eye(2)
"""No rotation."""


@dataclass(frozen=True)
class _Faces:
    """Contact faces compared along the load direction.

    Smallest distance, negative where the bodies overlap [m], and its position in space as text;
    area common to both faces [m²], and its extent as text; height [m] and name of the lower one of
    both bodies.
    """

    gap: float
    where: str
    area: float
    extent: str
    height: float
    body: str


def check_pair(mesh: AnyMesh, case: Case) -> None:
    """Check the relative position of both bodies, and their compression by the load.

    Raises
    ------
    CaseError
        If they overlap, are apart, or are compressed by a large part of their size.
    """
    bodies = whole_bodies(mesh, case.geometry)
    if not case.geometry.sized:  # CAD files have a unit of their own
        note_size(bodies)
    faces = _compared(bodies, case)
    height, overlap = faces.height, -faces.gap
    of_body = f"of {faces.body!r}, which is {length(height)} high"
    if overlap > SQUEEZED * height:
        raise CaseError(
            f"geometry.path: the bodies overlap by {length(overlap)}{faces.where}, "
            f"{overlap / height:.0%} {of_body}; move the faces to initial contact"
        )
    if faces.gap > height:
        raise CaseError(
            f"geometry.path: the bodies lie {length(faces.gap)} apart{faces.where}, more than the "
            f"height {of_body}; move the faces to initial contact"
        )
    approach = case.approach()
    if approach is not None:
        _check_approach(case, faces, approach, of_body)
    _check_pressure(case, faces)
    force, closed = case.force(), overlap
    if approach is not None:
        closed = approach - faces.gap
    elif force is not None:
        thickness = case.geometry.thickness_factor
        closed = depth(force, faces.area, softest(case)[1], thickness)
    note_polygons(bodies, case.geometry.contact, closed, "geometry.curved = [{}]")
    if overlap > MUCH * height:
        note(
            f"geometry.path: the bodies overlap by {length(overlap)} before loading{faces.where}, "
            f"{overlap / height:.1%} {of_body}"
        )
    if approach is None and faces.gap > _APART * height:
        note(
            f"geometry.path: the faces are {length(faces.gap)} apart before loading{faces.where}, "
            f"{faces.gap / height:.1%} {of_body}; move the faces to initial contact"
        )


def has_plane_faces(mesh: AnyMesh, case: Case) -> bool:
    """Whether both contact faces lie in a plane each, so that none can fold back."""
    for name in case.geometry.contact:
        if case.model == "3d":
            vector, area = area_vector(mesh, name)
        else:
            along = np.diff(pieces(block_with(mesh, name), name), axis=1)[:, 0]
            vector, area = along.sum(axis=0), float(np.hypot(*along.T).sum())
        if np.linalg.norm(vector) < (1 - _PLANE) * area:
            return False
    return True


def _check_approach(case: Case, faces: _Faces, approach: float, of_body: str) -> None:
    """Check that a prescribed approach closes the gap without excessive compression."""
    key = "load.history.approach" if case.load.approach is None else "load.approach"
    if approach - faces.gap > SQUEEZED * faces.height:
        raise CaseError(
            f"{key}: {length(approach)} compresses the bodies by "
            f"{(approach - faces.gap) / faces.height:.0%} {of_body} (check geometry.length_unit)"
        )
    alone = case.heat is None and not case.load.surfaces and case.geometry.initial_shape is None
    if alone and approach < faces.gap:
        raise CaseError(
            f"{key}: {length(approach)} does not close the gap of {length(faces.gap)} between "
            "the contact faces; there would be no contact"
        )


def _check_pressure(case: Case, faces: _Faces) -> None:
    """Check that the mean pressure of a prescribed force is small relative to the moduli."""
    force, area = case.force(), faces.area
    if force is None or area == 0.0:
        return
    note_pressure("load", force / area)
    check_pressure("load", force / area, f", for contact {faces.extent} of the faces,", case)


def _compared(mesh: AnyMesh, case: Case) -> _Faces:
    """Compare the contact faces along the load direction, -y in a section and -z in space."""
    geometry = case.geometry
    heights = {name: float(np.ptp(points_of(mesh, name)[:, -1])) for name in mesh.bodies}
    body = min(heights, key=heights.__getitem__)
    if case.model == "3d":
        found = compared_solids(mesh, geometry)
        extent = f"on the whole {1e6 * found.area:.4g} mm²"
        return _Faces(found.gap, f" {found.where}", found.area, extent, heights[body], body)
    gap, (start, end) = _gap(mesh, geometry)
    if case.model == "axisymmetric":
        area = np.pi * (end**2 - start**2)
    else:
        area = (end - start) * (geometry.thickness_factor or 0.0)
    return _Faces(gap, "", area, f"along the whole {length(end - start)}", heights[body], body)


def _gap(mesh: AnyMesh, geometry: Geometry) -> tuple[float, tuple[float, float]]:
    """Smallest gap between the contact faces of a section, and their common range of x [m]."""
    down, up = facing_pieces(mesh, geometry.contact)
    for facing, name, way in ((down, geometry.contact[0], "down"), (up, geometry.contact[1], "up")):
        if not len(facing):
            raise CaseError(
                f"geometry.contact: {name!r} does not face {way}; body {geometry.bodies[0]!r} is "
                f"loaded along -y, so it must lie above {geometry.bodies[1]!r}"
            )
    return section_gap(down, up, "geometry")


def facing_pieces(
    mesh: AnyMesh, names: tuple[str, str], turn: np.ndarray = _AS_THEY_ARE
) -> tuple[np.ndarray, np.ndarray]:
    """Segments of the first face of a section that face down, and of the second one that face up.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
    names : tuple of str
        Both faces.
    turn : ndarray, shape (2, 2)
        Rotation of the faces, after which they are compared along y.

    Returns
    -------
    tuple of ndarray, shape (n, 2 ends, 2) [m]
    """
    upper, lower = (pieces(block_with(mesh, name), name) @ turn.T for name in names)
    return upper[_normals(upper)[:, 1] < -_FACING], lower[_normals(lower)[:, 1] > _FACING]


def section_gap(down: np.ndarray, up: np.ndarray, path: str) -> tuple[float, tuple[float, float]]:
    """Smallest gap between the segments of two faces along y, and their common range of x [m].

    Parameters
    ----------
    down, up : ndarray, shape (n, 2 ends, 2)
        See `facing_pieces`.
    path : str
        Key that names the faces, for the message.

    Raises
    ------
    CaseError
        If they do not lie opposite each other.
    """
    first = max(down[..., 0].min(), up[..., 0].min())
    last = min(down[..., 0].max(), up[..., 0].max())
    if first >= last:
        raise CaseError(
            f"{path}: the contact faces do not lie opposite each other; they range from x = "
            f"{down[..., 0].min():.6g} to {down[..., 0].max():.6g} m and from "
            f"{up[..., 0].min():.6g} to {up[..., 0].max():.6g} m"
        )
    ends = np.concatenate([down[..., 0].ravel(), up[..., 0].ravel()])
    x = np.unique(ends[(ends >= first) & (ends <= last)])
    gap = -_highest(-down[..., 1], down[..., 0], x) - _highest(up[..., 1], up[..., 0], x)
    return float(np.nanmin(gap)), (float(first), float(last))


def pieces(mesh: TaggedMesh, surface: str) -> np.ndarray:
    """Straight segments of a surface, with their body on the left, shape (n, 2 ends, 2) [m]."""
    t = np.linspace(0.0, 1.0, 1 + (_PIECES * mesh.order if mesh.order > 1 else 1))
    values = shape_functions("interval", mesh.order, t[:, None])
    points = np.einsum("qk,fki->fqi", values, mesh.points[mesh.facets_of(surface)])
    return np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 2)


def _normals(pieces: np.ndarray) -> np.ndarray:
    """Outward unit normals, shape (n, 2)."""
    x, y = (pieces[:, 1] - pieces[:, 0]).T
    return np.column_stack([y, -x]) / np.hypot(x, y)[:, None]


def _highest(height: np.ndarray, across: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Largest height of segments (n, 2 ends) over points x; NaN where there is none, shape of x."""
    order = np.argsort(across, axis=1)
    left, right = np.take_along_axis(across, order, axis=1).T
    low, high = np.take_along_axis(height, order, axis=1).T
    result = np.empty(len(x))
    for start in range(0, len(x), _AT_ONCE):
        at = x[start : start + _AT_ONCE, None]
        share = np.clip((at - left) / (right - left), 0.0, 1.0)
        inside = (at >= left) & (at <= right)
        values = np.where(inside, low + share * (high - low), -np.inf)
        result[start : start + _AT_ONCE] = values.max(axis=1)
    return np.where(np.isfinite(result), result, np.nan)
