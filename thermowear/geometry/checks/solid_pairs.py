"""Relative position of the contact faces of two bodies in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from ...case.tables.geometry import Geometry
from ...errors import CaseError
from ...lagrange import gauss
from ..mesh.mixed import AnyMesh, block_with
from ..mesh.nodes import reference_nodes, shape_functions, slopes
from .solid_checks import at

_TRIANGLES = {
    ("triangle", 1): [(0, 1, 2)],
    ("triangle", 2): [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    ("quadrilateral", 1): [(0, 1, 2), (0, 2, 3)],
    ("quadrilateral", 2): [
        *[(0, 4, 8), (0, 8, 7), (4, 1, 5), (4, 5, 8)],
        *[(7, 8, 6), (7, 6, 3), (8, 5, 2), (8, 2, 6)],
    ],
}
"""Small triangles of flat and curved facets, by their nodes."""
_FACING = 0.05
"""Least cosine between a normal and the load direction of a facet that faces the other body."""
_NEAREST = 32
"""Number of triangles around a point among which the one above or below it is sought."""
_MOST = 20_000
"""Largest number of points of a face that are compared."""
_AS_THEY_ARE = np.eye(3)
"""No rotation."""


@dataclass(frozen=True)
class SolidFaces:
    """Contact faces compared along a direction, by default the load direction -z.

    Attributes
    ----------
    gap : float
        Smallest distance, negative where the bodies overlap [m].
    where : str
        Position of the smallest distance, as text.
    area : float
        Lesser area of both faces, projected along the direction [m²].
    """

    gap: float
    where: str
    area: float


def compared_solids(mesh: AnyMesh, geometry: Geometry) -> SolidFaces:
    """Compare the contact faces of two bodies along the load direction.

    Raises
    ------
    CaseError
        If they do not face each other.
    """
    names, bodies = geometry.contact, geometry.bodies
    down, up = facing_triangles(mesh, names)
    for facing, name, way in ((down, names[0], "down"), (up, names[1], "up")):
        if not len(facing):
            raise CaseError(
                f"geometry.contact: {name!r} does not face {way}; body {bodies[0]!r} is loaded "
                f"along -z, so it must lie above {bodies[1]!r}"
            )
    area = min(projected_area(mesh, name) for name in names)
    return distances(down, up, area, "geometry")


def facing_triangles(
    mesh: AnyMesh, names: tuple[str, str], turn: np.ndarray = _AS_THEY_ARE
) -> tuple[np.ndarray, np.ndarray]:
    """Small triangles of the first face that face down, and of the second one that face up [m].

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
    names : tuple of str
        Both faces.
    turn : ndarray, shape (3, 3)
        Rotation of the faces, after which they are compared along z.
    """
    upper, lower = (_triangles(mesh, name) @ turn.T for name in names)
    return upper[_cosines(upper) < -_FACING], lower[_cosines(lower) > _FACING]


def distances(
    down: np.ndarray, up: np.ndarray, area: float, path: str, turn: np.ndarray = _AS_THEY_ARE
) -> SolidFaces:
    """Compare triangles of two faces along z.

    Parameters
    ----------
    down, up : ndarray, shape (n, 3, 3)
        See `facing_triangles`.
    area : float
        Lesser projected area of both faces [m²].
    path : str
        Key that names the faces, for the message.
    turn : ndarray, shape (3, 3)
        Rotation of the faces before the comparison.

    Raises
    ------
    CaseError
        If they do not lie opposite each other.
    """
    of_upper, of_lower = _nodes(down), _nodes(up)
    below, above = of_upper[:, 2] - _heights(of_upper, up), _heights(of_lower, down)
    gaps = np.concatenate([below, above - of_lower[:, 2]])
    if np.isnan(gaps).all():
        ranges = " and ".join(
            ", ".join(
                f"{c} = {a:.6g} to {b:.6g} m" for c, a, b in zip("xy", *_box(of), strict=True)
            )
            for of in (of_upper @ turn, of_lower @ turn)
        )
        raise CaseError(
            f"{path}: the contact faces do not lie opposite each other; they range from {ranges}"
        )
    closest = int(np.nanargmin(gaps))
    where = at(np.concatenate([of_upper, of_lower])[closest : closest + 1] @ turn)
    return SolidFaces(float(gaps[closest]), where, area)


def area_vector(mesh: AnyMesh, surface: str) -> tuple[np.ndarray, float]:
    """Integral of the outward normal over a face, shape (3,), and its area [m²]."""
    x = _triangles(mesh, surface)
    normals = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]) / 2
    return normals.sum(axis=0), float(np.linalg.norm(normals, axis=1).sum())


def projected_area(mesh: AnyMesh, surface: str, turn: np.ndarray = _AS_THEY_ARE) -> float:
    """Area of a contact face projected along z, exact for its curved facets [m²].

    Of a face all round, as of a shaft, that of the half on one side.
    """
    mesh = block_with(mesh, surface)
    kind, order = mesh.facet_type, mesh.order
    points, weights = gauss(2 * order, kind)
    tangents = slopes(kind, order, points)
    s, t = np.einsum("qdk,fki->dfqi", tangents, mesh.points[mesh.facets_of(surface)] @ turn.T)
    areas = _cross(s, t) @ weights
    return float(max(areas[areas > 0.0].sum(), -areas[areas < 0.0].sum()))


def _triangles(mesh: AnyMesh, surface: str) -> np.ndarray:
    """Small triangles of a contact face, with outward normals, shape (n, 3, 3) [m]."""
    mesh = block_with(mesh, surface)
    kind, order = mesh.facet_type, min(mesh.order, 2)
    values = shape_functions(kind, mesh.order, reference_nodes(kind, order))
    points = np.einsum("qk,fki->fqi", values, mesh.points[mesh.facets_of(surface)])
    return points[:, np.array(_TRIANGLES[kind, order])].reshape(-1, 3, 3)


def _cosines(triangles: np.ndarray) -> np.ndarray:
    """Third component of the unit normals, shape (n,)."""
    x = triangles
    normals = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    return normals[:, 2] / np.linalg.norm(normals, axis=1)


def _nodes(triangles: np.ndarray) -> np.ndarray:
    """Corners of triangles, at most `_MOST` of them, shape (n, 3) [m]."""
    nodes = np.unique(triangles.reshape(-1, 3), axis=0)
    return nodes[:: 1 + len(nodes) // _MOST]


def _box(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return points.min(axis=0)[:2], points.max(axis=0)[:2]


def _heights(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Height of the triangle above or below each point, NaN where there is none, shape (n,)."""
    centres = triangles[..., :2].mean(axis=1)
    count = min(_NEAREST, len(centres))
    _, near = scipy.spatial.cKDTree(centres).query(points[:, :2], k=count)
    corners = triangles[near.reshape(len(points), count)]
    a, b, c = np.moveaxis(corners[..., :2], 2, 0)
    p = points[:, None, :2]
    whole = _cross(b - a, c - a)
    with np.errstate(invalid="ignore", divide="ignore"):
        s, t = _cross(p - a, c - a) / whole, _cross(b - a, p - a) / whole
    inside = (s >= -1e-6) & (t >= -1e-6) & (s + t <= 1 + 1e-6)
    z = corners[..., 2]
    height = z[..., 0] + s * (z[..., 1] - z[..., 0]) + t * (z[..., 2] - z[..., 0])
    found = inside.argmax(axis=1)[:, None]
    height = np.take_along_axis(height, found, axis=1)[:, 0]
    return np.where(inside.any(axis=1), height, np.nan)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
