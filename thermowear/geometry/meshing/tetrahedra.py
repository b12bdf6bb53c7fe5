"""Curved tetrahedra: by gmsh, refined around a contact, or in rows round an axis.

Every tetrahedron is a part of the prism between two positions of a triangle, and all nodes lie on
circles: finite element spaces on such meshes contain fields that are uniform round the axis.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...errors import CaseError
from ..mesh.gmsh_session import gmsh_model
from ..mesh.nodes import boundary, numbered, reference_nodes, turned
from .cells import MeshedBody
from .divisions import check_count

MOST_TETRAHEDRA = 1_000_000
"""Largest number of tetrahedra of a body."""
GROWTH = 0.35
"""Increase of the element size per distance from the contact."""
CELLS_PER_CUBE = 8.0
"""Number of tetrahedra in a cube of their size."""
_TETRAHEDRON = {1: 4, 2: 11}
"""Element types of gmsh by order."""

Draw = Callable[..., dict[str, list[int]]]
"""Draw bodies with gmsh's OpenCASCADE kernel: ``draw(occ)`` returns their volumes by name."""


class SizeZone(Protocol):
    """Element sizes of a body around a contact."""

    @property
    def edge(self) -> float:
        """Element size at the edge of the contact [m]."""

    @property
    def largest(self) -> float:
        """Largest element size [m]."""

    @property
    def per_turn(self) -> int:
        """Least number of elements round a circle."""

    def expressions(self, unit: float) -> tuple[str, ...]:
        """Sizes due to the contact and to its edge, as gmsh's ``MathEval``, in a length unit."""

    def cells(self) -> float:
        """Estimate of the number of tetrahedra of the body."""


@dataclass(frozen=True)
class RoundZone:
    """Element sizes around a round contact in the plane z = 0.

    Attributes
    ----------
    center : float
        Distance of its centre from the origin, along x [m].
    radius : float [m]
    inside : float
        Element size in the middle [m].
    edge : float
        Element size at its edge [m].
    largest : float
        Largest element size of the body [m].
    volume : float
        Volume of the body, for an estimate of the number of cells [m³].
    """

    center: float
    radius: float
    inside: float
    edge: float
    largest: float
    volume: float
    per_turn = 24

    def expressions(self, unit: float) -> tuple[str, str]:
        """Sizes due to the contact and to its edge, as gmsh's ``MathEval``, in a length unit."""
        center, radius, inside, edge = (
            f"({value / unit!r})" for value in (self.center, self.radius, self.inside, self.edge)
        )
        beside = f"(Sqrt((x-{center})*(x-{center})+y*y)-{radius})"
        outside = f"(0.5*({beside}+Fabs({beside})))"
        from_zone = f"Sqrt({outside}*{outside}+z*z)"
        from_edge = f"Sqrt({beside}*{beside}+z*z)"
        return f"{inside}+{GROWTH}*{from_zone}", f"{edge}+{GROWTH}*{from_edge}"

    def cells(self) -> float:
        """Estimate of the number of tetrahedra of the body."""
        far = np.geomspace(1e-3 * self.edge, max(self.largest / GROWTH, self.radius), 400)
        size = np.minimum(self.inside + GROWTH * far, self.largest)
        near_edge = np.minimum(self.edge + GROWTH * far, self.inside)
        within = math.pi * self.radius**2 / self.inside**2
        shells = np.trapezoid(2 * math.pi * (self.radius + far) ** 2 / size**3, far)
        tori = np.trapezoid(2 * math.pi**2 * self.radius * far / near_edge**3, far)
        tori -= np.trapezoid(2 * math.pi**2 * self.radius * far / self.inside**3, far)
        return CELLS_PER_CUBE * (within + shells + max(tori, 0.0) + self.volume / self.largest**3)


@dataclass(frozen=True)
class SectorZone:
    """Element sizes around a contact in a sector of an annulus in the plane z = 0.

    Attributes
    ----------
    radii : tuple of float
        Inner and outer radius, about the z-axis [m].
    half_angle : float
        Half of its angle, symmetric about the x-axis [rad].
    sizes : tuple of float
        Element sizes inside, at the edge, and far away [m].
    depth : float
        Thickness of the body at the contact [m].
    """

    radii: tuple[float, float]
    half_angle: float
    sizes: tuple[float, float, float]
    depth: float
    per_turn = 12

    @property
    def edge(self) -> float:
        return self.sizes[1]

    @property
    def largest(self) -> float:
        return self.sizes[2]

    def expressions(self, unit: float) -> tuple[str, str]:
        """Sizes due to the contact and to its edge, as gmsh's ``MathEval``, in a length unit."""
        inner, outer = self.radii
        middle, half, inside, edge = (
            f"({value / unit!r})"
            for value in ((inner + outer) / 2, (outer - inner) / 2, *self.sizes[:2])
        )
        r = "Sqrt(x*x+y*y)"
        across = f"(Fabs({r}-{middle})-{half})"
        along = f"({r}*(Acos(x/({r}+1e-12))-{self.half_angle!r}))"
        outside = [f"(0.5*({beside}+Fabs({beside})))" for beside in (across, along)]
        away = f"({outside[0]}*{outside[0]}+{outside[1]}*{outside[1]})"
        nearest = f"(0.5*({across}+{along}+Fabs({across}-{along})))"  # the larger one
        within = f"(0.5*({nearest}-Fabs({nearest})))"
        from_zone = f"Sqrt({away}+z*z)"
        from_edge = f"Sqrt({away}+{within}*{within}+z*z)"
        return f"{inside}+{GROWTH}*{from_zone}", f"{edge}+{GROWTH}*{from_edge}"

    def cells(self) -> float:
        """Estimate of the number of tetrahedra of the body."""
        inside, edge, largest = self.sizes
        inner, outer = self.radii
        area = self.half_angle * (outer**2 - inner**2)
        around = 2 * (outer - inner) + 2 * self.half_angle * (outer + inner)
        away = np.geomspace(1e-3 * edge, max(self.depth, edge), 400)
        below = np.trapezoid(1 / np.minimum(inside + GROWTH * away, largest) ** 3, away)
        near = np.minimum(edge + GROWTH * away, inside) ** -3 - inside**-3
        edges = np.trapezoid(math.pi / 2 * away * near, away)
        surface = 1 / inside**2 + below
        return CELLS_PER_CUBE * (area * surface + around * max(edges, 0.0))


def mesh_solids(
    draw: Draw, zones: Mapping[str, SizeZone], order: int, unit: float
) -> dict[str, MeshedBody]:
    """Mesh solids that may touch each other by gmsh.

    The triangles of a surface that two solids share are the same on both, while its nodes are not.

    Parameters
    ----------
    draw : callable
        Draws the solids, all lengths divided by `unit`.
    zones : dict of str to RoundZone or SectorZone
        Sizes by body, equal at the contact.
    order : int
        Order of the cells, 1 or 2.
    unit : float
        Length in which gmsh computes, as its tolerances are absolute [m].

    Raises
    ------
    CaseError
        If there were too many cells, or gmsh fails.
    """
    for zone in zones.values():
        check_count(zone.cells(), most=MOST_TETRAHEDRA)
    with gmsh_model("solids") as gmsh:
        volumes = draw(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        _set_sizes(gmsh, zones, volumes, unit)
        try:
            gmsh.model.mesh.generate(3)
            gmsh.model.mesh.setOrder(order)
            if order > 1:
                gmsh.model.mesh.optimize("HighOrder")
        except Exception as trouble:  # gmsh raises nothing more specific
            raise CaseError(f"geometry: gmsh could not mesh the bodies: {trouble}") from None
        return {name: _read(gmsh.model, volumes[name], order, unit) for name in zones}


def _set_sizes(gmsh, zones: Mapping[str, SizeZone], volumes: dict[str, list[int]], unit: float):
    """Set the size field of bodies: refined at the contact, limited in each of them."""
    fields, parts = gmsh.model.mesh.field, []
    zone = next(iter(zones.values()))
    for expression in zone.expressions(unit):
        parts.append(fields.add("MathEval"))
        fields.setString(parts[-1], "F", expression)
    for name, own in zones.items():
        parts.append(fields.add("Constant"))
        fields.setNumber(parts[-1], "VIn", own.largest / unit)
        fields.setNumbers(parts[-1], "VolumesList", volumes[name])
    least = fields.add("Min")
    fields.setNumbers(least, "FieldsList", parts)
    fields.setAsBackgroundMesh(least)
    settings = {
        "MeshSizeMin": 0.3 * zone.edge / unit,
        "MeshSizeMax": max(own.largest for own in zones.values()) / unit,
        "MeshSizeFromPoints": 0,
        "MeshSizeExtendFromBoundary": 0,
        "MeshSizeFromCurvature": zone.per_turn,
        "Algorithm": 6,
        "Algorithm3D": 1,
        "Optimize": 1,
    }
    for name, value in settings.items():
        gmsh.option.setNumber(f"Mesh.{name}", value)


def _read(model, volumes: list[int], order: int, unit: float) -> MeshedBody:
    """Tetrahedra of some volumes of a meshed model, and their boundary."""
    count = (order + 1) * (order + 2) * (order + 3) // 6
    kind = _TETRAHEDRON[order]
    found = [model.mesh.getElementsByType(kind, volume)[1] for volume in volumes]
    nodes = np.concatenate(found).astype(np.int64).reshape(-1, count)
    if not len(nodes):
        raise CaseError("geometry: gmsh could not mesh the bodies with tetrahedra")
    tags, coordinates, _ = model.mesh.getNodes()
    used, cells = np.unique(nodes, return_inverse=True)
    row = np.empty(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    points = unit * coordinates.reshape(-1, 3)[row[used]]
    cells = cells.reshape(nodes.shape).astype(np.int64)
    inverted = np.linalg.det(points[cells[:, 1:4]] - points[cells[:, :1]]) < 0
    cells[inverted] = cells[inverted][:, turned("tetrahedron", order)]
    return MeshedBody(points, cells, boundary("tetrahedron", order, cells))


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
