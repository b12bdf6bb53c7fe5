"""Curved quadrilaterals and hexahedra without a mesh generator: cells of parameters, and a map.

A sheet holds cells by their corners in two plane parameters and the map to the section; cells in
space have the element ends of three parameters and a map. Nodes of cells of any order are images of
equally spaced parameters, so nodes of a curved boundary lie on it exactly and the interior ones
follow the map. Surfaces are named by predicates of their facets.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...lagrange import matching
from ..mesh.nodes import boundary, components, reference_nodes
from ..mesh.tagged import TaggedMesh
from .divisions import MOST_HEXAHEDRA, check_count

ORDER = 3
"""Order of cells on arcs; nodes lie on an arc, points between them within 3e-4 h⁴/R³ of it."""

Claim = Callable[[np.ndarray], np.ndarray]
"""Predicate of a surface: mask of boundary facets, given by their nodes (n_facets, nodes, gdim)."""


@dataclass(frozen=True)
class Sheet:
    """Cells in the plane of two parameters.

    Attributes
    ----------
    corners : ndarray, shape (n_cells, 4, 2)
        Corners in order around each cell, of either orientation.
    place : callable
        Map from parameters to coordinates, both of shape (..., 2), by default the identity [m].
    zone : str
        Zone of the body with a material of its own; empty for the body itself.
    """

    corners: np.ndarray
    place: Callable[[np.ndarray], np.ndarray] = np.asarray
    zone: str = ""


@dataclass(frozen=True)
class MeshedBody:
    """Meshed body, of quadrilaterals in the plane or of hexahedra in space.

    Attributes
    ----------
    points : ndarray, shape (n_points, gdim) [m]
    cells : ndarray of int64, shape (n_cells, (order + 1)**gdim)
        Nodes in gmsh's order.
    facets : ndarray of int64, shape (n_facets, (order + 1)**(gdim - 1))
        Boundary facets, nodes in gmsh's order.
    zones : dict of str to ndarray of int
        Indices of the cells of its zones.
    """

    points: np.ndarray
    cells: np.ndarray
    facets: np.ndarray
    zones: dict[str, np.ndarray] = field(default_factory=dict)


def grid(columns: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Corners of the cells of a tensor grid, shape (n_columns * n_rows, 4, 2)."""
    check_count(len(columns) - 1, len(rows) - 1)
    x, y = np.meshgrid(columns, rows, indexing="ij")
    p = np.stack([x, y], axis=-1)
    corners = np.stack([p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]], axis=2)
    return corners.reshape(-1, 4, 2)


def ruled(
    curve: Callable[[np.ndarray], np.ndarray], line: np.ndarray, along: np.ndarray, v: np.ndarray
) -> Sheet:
    """Cells between a curve and a straight line.

    Column widths vary linearly from the given ones on the curve to equal ones on the line.

    Parameters
    ----------
    curve : callable
        Point of the curve at a parameter.
    line : ndarray, shape (2, 2)
        Ends of the line, opposite to the first and last of `along` [m].
    along : ndarray
        Parameters of the curve at the column ends, increasing.
    v : ndarray
        Row ends, from 0 on the curve to 1 on the line.
    """
    extent = along[-1] - along[0]
    t, count = (along - along[0]) / extent, len(along) - 1

    def place(p):
        across, down = p[..., 0, None], p[..., 1, None]
        on_curve = curve(along[0] + across[..., 0] * extent)
        return (1 - down) * on_curve + down * ((1 - across) * line[0] + across * line[1])

    cells = grid(np.arange(count + 1.0), v)
    column, row = cells[..., 0].astype(int), cells[..., 1]
    cells[..., 0] = (1 - row) * t[column] + row * column / count
    return Sheet(cells, place)


def mesh_body(sheets: list[Sheet], order: int) -> MeshedBody:
    """Cells of all sheets, with coinciding nodes merged."""
    nodes = np.concatenate([_nodes(sheet, order) for sheet in sheets])
    points, cells = _joined(nodes)
    zone = np.repeat([sheet.zone for sheet in sheets], [len(sheet.corners) for sheet in sheets])
    zones = {str(name): np.flatnonzero(zone == name) for name in np.unique(zone) if name}
    return MeshedBody(points, cells, boundary("quadrilateral", order, cells), zones)


def level(axis: int, value: float) -> Claim:
    """Predicate of the facets with all nodes at a coordinate."""
    return lambda p: np.all(
        np.abs(p[..., axis] - value) < 1e-9 * np.ptp(p, axis=(0, 1)).max(), axis=1
    )


def between(first: float, last: float, axis: int = 0) -> Claim:
    """Predicate of the facets whose midpoint is in a range of a coordinate."""

    def claim(p):
        middle = p[..., axis].mean(axis=1)
        return (first < middle) & (middle < last)

    return claim


def both(*claims: Claim) -> Claim:
    """Predicate of the facets that fulfil all of some predicates."""
    return lambda p: np.logical_and.reduce([claim(p) for claim in claims])


def every(p: np.ndarray) -> np.ndarray:
    """Predicate of all facets, for those that no other surface claims."""
    return np.ones(len(p), dtype=bool)


def tagged_bodies(bodies: dict[str, MeshedBody], surfaces: dict[str, Claim]) -> TaggedMesh:
    """Assemble meshed bodies and name their boundary.

    Parameters
    ----------
    bodies : dict of str to MeshedBody
        Bodies by name, body 1 first.
    surfaces : dict of str to callable
        Predicate of each surface, named ``body_surface`` (of the longest such body); a facet
        belongs to the first surface of its body whose predicate is true.
    """
    names = [*bodies, *(zone for body in bodies.values() for zone in body.zones)]
    shift, points, cells, cell_tags, facets, facet_tags = 0, [], [], [], [], []
    for tag, (name, body) in enumerate(bodies.items(), start=1):
        places = body.points[body.facets]
        marks = np.zeros(len(body.facets), dtype=np.int32)
        for mark, (surface, claims) in enumerate(surfaces.items(), start=1):
            if _owner(surface, bodies) == name:
                marks[(marks == 0) & claims(places)] = mark
        points.append(body.points)
        cells.append(body.cells + shift)
        cell_tags.append(np.full(len(body.cells), tag, dtype=np.int32))
        for zone, members in body.zones.items():
            cell_tags[-1][members] = names.index(zone) + 1
        facets.append(body.facets[marks > 0] + shift)
        facet_tags.append(marks[marks > 0])
        shift += len(body.points)
    return TaggedMesh(
        points=np.concatenate(points),
        cell_type="quadrilateral" if points[0].shape[1] == 2 else "hexahedron",
        cells=np.concatenate(cells),
        cell_tags=np.concatenate(cell_tags),
        facets=np.concatenate(facets),
        facet_tags=np.concatenate(facet_tags),
        bodies=tuple(names),
        surfaces=tuple(surfaces),
    )


def _owner(surface: str, bodies: Iterable[str]) -> str:
    """Body that a surface belongs to."""
    return max((name for name in bodies if surface.startswith(f"{name}_")), key=len, default="")


def _nodes(sheet: Sheet, order: int) -> np.ndarray:
    """Nodes of all cells of a sheet, shape (n_cells, (order + 1)², 2) [m]."""
    placed = sheet.place(sheet.corners)
    diagonals = placed[:, 2] - placed[:, 0], placed[:, 3] - placed[:, 1]
    inverted = diagonals[0][:, 0] * diagonals[1][:, 1] < diagonals[0][:, 1] * diagonals[1][:, 0]
    corners = sheet.corners.copy()
    corners[inverted] = corners[inverted][:, ::-1]
    x, y = reference_nodes("quadrilateral", order).T
    weights = np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y], axis=1)
    return sheet.place(np.einsum("kc,nci->nki", weights, corners))


def _joined(nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Merge coinciding nodes: coordinates, and the point indices of each cell."""
    from scipy.spatial import cKDTree

    sides = np.linalg.norm(nodes[:, [1, 2, 3, 0]] - nodes[:, :4], axis=2)
    flat = nodes.reshape(-1, 2)
    pairs = cKDTree(flat).query_pairs(1e-3 * sides.min(), output_type="ndarray")
    label = components(pairs, len(flat))
    _, first = np.unique(label, return_index=True)
    return flat[first], label.reshape(nodes.shape[:2]).astype(np.int64)


def mesh_lattice(
    ends: Sequence[np.ndarray],
    order: int,
    place: Callable[[np.ndarray], np.ndarray] = np.asarray,
    closed: bool = False,
) -> MeshedBody:
    """Mesh a lattice of hexahedra in the space of three parameters.

    Parameters
    ----------
    ends : sequence of ndarray
        Element ends along each parameter, increasing.
    order : int
        Order of the cells.
    place : callable
        Orientation-preserving map from parameters to coordinates, both of shape (..., 3), by
        default the identity [m].
    closed : bool
        True if the second parameter, an angle, is periodic.
    """
    counts = [len(along) - 1 for along in ends]
    check_count(*counts, most=MOST_HEXAHEDRA)
    u, v, w = (_parameters(along, order) for along in ends)
    if closed:
        v = v[:-1]
    points = place(np.stack(np.meshgrid(u, v, w, indexing="ij"), axis=-1).reshape(-1, 3))
    first = np.indices(counts).reshape(3, -1, 1) * order
    within = np.rint(order * reference_nodes("hexahedron", order)).astype(np.int64)
    number = first + within.T[:, None]
    number[1] %= len(v)
    cells = np.ravel_multi_index(tuple(number), (len(u), len(v), len(w)))
    return MeshedBody(points, cells, boundary("hexahedron", order, cells))


def divided_hexahedra(body: MeshedBody, order: int) -> MeshedBody:
    """Mesh in which each hexahedron is six tetrahedra along its diagonal (Kuhn), same nodes."""
    nodes = reference_nodes("tetrahedron", order)
    cells = []
    for axes in itertools.permutations(np.eye(3)):
        ends = np.cumsum([np.zeros(3), *axes], axis=0)
        if np.linalg.det(axes) < 0:
            ends[[1, 2]] = ends[[2, 1]]
        places = ends[0] + nodes @ (ends[1:] - ends[0])
        cells.append(body.cells[:, matching(places, reference_nodes("hexahedron", order))])
    every = np.concatenate(cells)
    return MeshedBody(body.points, every, boundary("tetrahedron", order, every))


def _parameters(ends: np.ndarray, order: int) -> np.ndarray:
    """Parameters of the nodes of a row of elements."""
    within = np.arange(order) / order
    inner = ends[:-1, None] + np.diff(ends)[:, None] * within
    return np.append(inner.ravel(), ends[-1])
