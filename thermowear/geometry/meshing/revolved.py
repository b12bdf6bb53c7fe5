"""Curved tetrahedra in rows round an axis: the triangles of a section by gmsh, revolved.

Every tetrahedron is a part of the prism between two positions of a triangle, and all nodes lie on
circles: finite element spaces on such meshes contain fields that are uniform round the axis.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...errors import CaseError
from ..mesh.gmsh_session import gmsh_model
from ..mesh.nodes import boundary, numbered, reference_nodes, turned
from .cells import MeshedBody
from .divisions import check_count
from .tetrahedra import GROWTH, MOST_TETRAHEDRA

_PRISM = np.array([[0, 1, 2, 5], [0, 1, 4, 5], [0, 3, 4, 5]])
"""Corners of three tetrahedra of a prism with the triangles 0, 1, 2 and 3, 4, 5.

Diagonals ascend in the order of the corners: they agree on prisms that number them alike.
"""
_TRIANGLE = 2
"""Element type of gmsh."""
_PER_SQUARE = 2.5
"""Number of triangles in a square of their size."""


def mesh_polygon(
    corners: np.ndarray, sizes: Sequence[str], largest: float, unit: float
) -> tuple[np.ndarray, np.ndarray]:
    """Mesh a polygon by gmsh.

    Parameters
    ----------
    corners : ndarray, shape (n, 2)
        In order; also points of its sides that become nodes [m].
    sizes : sequence of str
        Element sizes as gmsh's ``MathEval`` of x and y, all lengths divided by `unit`.
    largest : float
        Largest element size [m].
    unit : float
        Length in which gmsh computes, as its tolerances are absolute [m].

    Returns
    -------
    points : ndarray, shape (n_points, 2) [m]
    triangles : ndarray of int64, shape (n_triangles, 3)

    Raises
    ------
    CaseError
        If gmsh fails.
    """
    with gmsh_model("section") as gmsh:
        occ, fields = gmsh.model.occ, gmsh.model.mesh.field
        points = [occ.addPoint(x / unit, y / unit, 0.0) for x, y in corners]
        sides = zip(points, points[1:] + points[:1], strict=True)
        occ.addPlaneSurface([occ.addWire([occ.addLine(*side) for side in sides])])
        occ.synchronize()
        parts = [fields.add("MathEval") for _ in sizes]
        for part, size in zip(parts, sizes, strict=True):
            fields.setString(part, "F", size)
        least = fields.add("Min")
        fields.setNumbers(least, "FieldsList", parts)
        fields.setAsBackgroundMesh(least)
        settings = {"FromPoints": 0, "ExtendFromBoundary": 0, "Max": largest / unit}
        for name, value in settings.items():
            gmsh.option.setNumber(f"Mesh.MeshSize{name}", value)
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        try:
            gmsh.model.mesh.generate(2)
        except Exception as trouble:  # gmsh raises nothing more specific
            raise CaseError(f"geometry: gmsh could not mesh the section: {trouble}") from None
        nodes = gmsh.model.mesh.getElementsByType(_TRIANGLE)[1].astype(np.int64)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.empty(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    used, triangles = np.unique(row[nodes], return_inverse=True)
    return unit * coordinates.reshape(-1, 3)[used, :2], triangles.reshape(-1, 3)


def row_sizes(
    radii: tuple[float, float], faces: Sequence[float], sizes: tuple[float, float], unit: float
) -> list[str]:
    """Element sizes of a section of a disk for `mesh_polygon`, finer at rubbed faces.

    Parameters
    ----------
    radii : tuple of float
        Inner and outer radius of the rubbed faces [m].
    faces : sequence of float
        Their heights z [m].
    sizes : tuple of float
        Element sizes at the faces and at their edges [m].
    unit : float
        Length of gmsh [m].
    """
    inner, outer, inside, edge = (f"({value / unit!r})" for value in (*radii, *sizes))
    beside = f"(Fabs(x-({inner}+{outer})/2)-({outer}-{inner})/2)"
    away = f"(0.5*({beside}+Fabs({beside})))"
    found = []
    for face in faces:
        depth = f"(y-({face / unit!r}))"
        found.append(f"{inside}+{GROWTH}*Sqrt({away}*{away}+{depth}*{depth})")
        for end in (inner, outer):
            found.append(f"{edge}+{GROWTH}*Sqrt((x-{end})*(x-{end})+{depth}*{depth})")
    return found


def check_revolved(area: float, size: float, layers: int) -> None:
    """Reject sections that would be divided into too many cells.

    Parameters
    ----------
    area : float
        Area that is finely meshed [m²].
    size : float
        Element size there [m].
    layers : int
        Number of layers round the axis.
    """
    check_count(len(_PRISM) * _PER_SQUARE * area / size**2, layers, most=MOST_TETRAHEDRA)


def revolved(
    points: np.ndarray, triangles: np.ndarray, angles: np.ndarray, order: int
) -> MeshedBody:
    """Revolve a section about the z-axis, all round.

    Parameters
    ----------
    points : ndarray, shape (n_points, 2)
        Distance from the axis and z [m].
    triangles : ndarray of int, shape (n_triangles, 3)
    angles : ndarray, shape (n_layers + 1,)
        Ends of the layers, ascending; the last is a turn after the first [rad].
    order : int
        Order of the cells, 1 or 2.

    Raises
    ------
    CaseError
        If there were too many cells.
    """
    layers = len(angles) - 1
    check_count(len(_PRISM) * len(triangles), layers, most=MOST_TETRAHEDRA)
    section, between = _section_nodes(points, triangles, order)
    ends = _ends(order)  # of the edges on which the nodes of the three tetrahedra lie
    in_section = between[:, ends[..., 0] % 3, ends[..., 1] % 3]
    steps = order * layers  # positions of nodes round the axis
    within = (ends >= 3).sum(axis=2) if order > 1 else (ends[..., 0] >= 3).astype(int)
    position = (within + order * np.arange(layers)[:, None, None]) % steps
    cells = (in_section[None] * steps + position[:, None]).reshape(-1, ends.shape[1])
    at = np.interp(np.arange(steps) / order, np.arange(layers + 1), angles)
    r, z = section.T[:, :, None]
    places = np.stack(np.broadcast_arrays(r * np.cos(at), r * np.sin(at), z), axis=-1)
    used, cells = np.unique(cells, return_inverse=True)
    cells, places = cells.reshape(-1, ends.shape[1]), places.reshape(-1, 3)[used]
    sides = places[cells[:, 1:4]] - places[cells[:, :1]]
    inverted = np.linalg.det(sides) < 0
    cells[inverted] = cells[inverted][:, turned("tetrahedron", order)]
    return MeshedBody(places, cells, boundary("tetrahedron", order, cells))


def _section_nodes(
    points: np.ndarray, triangles: np.ndarray, order: int
) -> tuple[np.ndarray, np.ndarray]:
    """Nodes of a section, and those between all pairs of corners of its triangles.

    The corners of each triangle are taken in ascending order, so that diagonals of prisms agree.

    Returns
    -------
    nodes : ndarray, shape (n_nodes, 2) [m]
    between : ndarray of int64, shape (n_triangles, 3, 3)
        On the diagonal the corners.
    """
    triangles = np.sort(triangles, axis=1)
    pairs = np.array([(0, 1), (0, 2), (1, 2)])
    edges = triangles[:, pairs].reshape(-1, 2)
    edge, _ = numbered(edges)
    _, first = np.unique(edge, return_index=True)
    between: np.ndarray = np.empty((len(triangles), 3, 3), dtype=np.int64)
    between[:, range(3), range(3)] = triangles
    for column, (i, j) in enumerate(pairs):
        between[:, i, j] = between[:, j, i] = len(points) + edge.reshape(-1, 3)[:, column]
    if order == 1:
        return points, between
    return np.vstack([points, points[edges[first]].mean(axis=1)]), between


def _ends(order: int) -> np.ndarray:
    """Corners of the prism between which the nodes of its tetrahedra lie, shape (3, n_nodes, 2).

    Twice the same corner for a node at it.
    """
    nodes = reference_nodes("tetrahedron", order)
    weights = np.column_stack([1 - nodes.sum(axis=1), nodes])
    pairs = [np.flatnonzero(row > 1e-9) for row in weights]
    local = np.array([[pair[0], pair[-1]] for pair in pairs])
    return _PRISM[:, local]
