"""Values of fields at points of the bodies, and their transfer to another mesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import NamedTuple

import basix
import numpy as np
import scipy.sparse as sp
from dolfinx import fem

from ..compat import coordinate_element, geometry_dofmap
from ..lagrange import equispaced, tabulated
from .bodies import Bodies, BodyMesh
from .spaces import Spaces, as_function, reference_element

_MAX_NEWTON_STEPS = 20
_CONTROL_POINT = 0.76
"""Position of the control point, as a fraction of the way from a cell's first corner to its
midpoint."""
_BLOCK_SIZE = 2_000_000
"""Largest number of point-cell pairs searched at once."""
_TOLERANCE = 1e-6
"""Tolerance of the bounding-box search, relative to the size of a cell."""
_BULGE = 0.3
"""Tolerance for curved cells, whose sides bulge beyond the box of their nodes."""


class CellValues(NamedTuple):
    """Geometry nodes of cells, shape (n_cells, n_nodes, gdim), and nodal values in them."""

    nodes: np.ndarray
    values: np.ndarray


class CellSearch:
    """Search of the cells of points, and evaluation of fields there.

    Parameters
    ----------
    mesh : dolfinx.mesh.Mesh
        Mesh with cells of that type and order.
    degree : int
        Degree of the fields.
    """

    def __init__(self, mesh, degree: int):
        self._element = reference_element(mesh, degree)
        kind = self._element.cell_type
        order = coordinate_element(mesh).degree
        self._geometry = equispaced(kind.name, order)
        self._room = _TOLERANCE if order == 1 else _BULGE
        self._middle = np.asarray(basix.geometry(kind)).mean(axis=0)
        self._simplex = kind in (basix.CellType.triangle, basix.CellType.tetrahedron)

    def between_nodes(self, cells: CellValues) -> tuple[np.ndarray, np.ndarray]:
        """Control point of each cell, not a node for any degree, and the values there."""
        place = _CONTROL_POINT * self._middle[None]
        elements = self._geometry, self._element
        shape, values = (tabulated(element, place)[0, 0] for element in elements)
        return np.einsum("k,cki->ci", shape, cells.nodes), cells.values @ values

    def at(self, cells: CellValues, points: np.ndarray) -> np.ndarray:
        """Values at points, evaluated in the containing (or else the nearest) cell."""
        chunk = max(1, _BLOCK_SIZE // len(cells.nodes))
        parts = [self._at(cells, points[i : i + chunk]) for i in range(0, len(points), chunk)]
        return np.concatenate([np.empty(0), *parts])

    def _at(self, cells: CellValues, points: np.ndarray) -> np.ndarray:
        low, high = _boxes(cells.nodes)
        near = np.ones((len(points), len(low)), dtype=bool)
        for k in range(points.shape[1]):
            near &= points[:, k, None] >= low[:, k]
            near &= points[:, k, None] <= high[:, k]
        lost = np.flatnonzero(~near.any(axis=1))
        centres = cells.nodes.mean(axis=1)
        for point in lost:
            near[point, np.linalg.norm(centres - points[point], axis=1).argmin()] = True
        which, cell = np.nonzero(near)
        inside, outside = self.places(cells.nodes[cell], points[which])
        order = np.lexsort((outside, which))
        _, first = np.unique(which[order], return_index=True)
        best = order[first]
        values = tabulated(self._element, inside[best])[0]
        return np.einsum("nk,nk->n", values, cells.values[cell[best]])

    def near(
        self, nodes: np.ndarray, point: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Cells that may contain a point.

        Parameters
        ----------
        nodes : ndarray, shape (n_cells, n_nodes, gdim)
            Geometry nodes of the cells.
        point : ndarray, shape (gdim,)

        Returns
        -------
        cells : ndarray of int, shape (n,)
        places : ndarray, shape (n, gdim)
            Nearest reference coordinates in each cell.
        distances : ndarray, shape (n,)
            Distance of the point from there, in reference coordinates or relative to the size of
            the cell, whichever is larger.
        """
        low, high = _boxes(nodes, self._room)
        cells = np.flatnonzero(np.all((point >= low) & (point <= high), axis=1))
        nodes = nodes[cells]
        places, distances = self.places(nodes, np.tile(point, (len(cells), 1)))
        reached = np.einsum("nk,nki->ni", tabulated(self._geometry, places)[0], nodes)
        off = np.linalg.norm(reached - point, axis=1) / np.ptp(nodes, axis=1).max(axis=1)
        return cells, places, np.maximum(distances, off)

    def places(self, nodes: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nearest reference coordinates in one cell for each point, and the distances to them."""
        return self._clipped(self._unbounded(nodes, points))

    def _unbounded(self, nodes: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Reference coordinates of points for one cell each, by Newton's method."""
        place = np.tile(self._middle, (len(points), 1))
        for _ in range(_MAX_NEWTON_STEPS if len(points) else 0):
            table = tabulated(self._geometry, place, 1)
            off = np.einsum("nk,nki->ni", table[0], nodes) - points
            tangents = np.einsum("dnk,nki->nid", table[1:], nodes)
            step = np.linalg.solve(tangents, off[..., None])[..., 0]
            place = np.clip(place - step, -1.0, 2.0)
            if np.abs(step).max() < 1e-13:
                break
        return place

    def _clipped(self, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nearest reference coordinates inside the cell, and the distances to them."""
        inside = np.clip(place, 0.0, 1.0)
        if self._simplex:
            inside = inside / np.maximum(inside.sum(axis=1, keepdims=True), 1.0)
        return inside, np.linalg.norm(place - inside, axis=1)


def _boxes(nodes: np.ndarray, larger: float = _TOLERANCE) -> tuple[np.ndarray, np.ndarray]:
    """Corners of the bounding boxes of cells, slightly larger, shape (n_cells, gdim) each [m]."""
    low, high = nodes.min(axis=1), nodes.max(axis=1)
    room = larger * (high - low).max(axis=1, keepdims=True)
    return low - room, high + room


_INSIDE = 1e-6
"""Largest distance of a point from its cell, see `CellSearch.near`."""


@dataclass(frozen=True)
class CellPoint:
    """Point in a cell that this rank owns.

    Attributes
    ----------
    distance : float
        Distance from the cell, see `CellSearch.near`; zero inside, to rounding.
    body, cell : int
        Index of the body in `Bodies.each`, and local index of the cell.
    place : ndarray, shape (gdim,)
        Reference coordinates.
    """

    distance: float
    body: int
    cell: int
    place: np.ndarray


def located(
    bodies: Bodies, points: Sequence[tuple[float, ...]], owners: Mapping[str, str]
) -> list[dict[str, CellPoint | None]]:
    """Cells of points by the name of the owner of their parts. Every rank calls.

    Parameters
    ----------
    bodies : Bodies
    points : sequence of tuple of float [m]
    owners : mapping of str to str
        Owner of each part.

    Returns
    -------
    list of dict
        For each point its owners, the same on all ranks; with the cell on one rank, None on others.
    """
    rows = []
    for point in points:
        found: dict[str, CellPoint] = {}
        for index, body in enumerate(bodies.each):
            for owner, at in _in_body(body, index, np.array(point), owners).items():
                if owner not in found or at.distance < found[owner].distance:
                    found[owner] = at
        rows.append(found)
    distances = bodies.comm.allgather([{k: at.distance for k, at in row.items()} for row in rows])
    result: list[dict[str, CellPoint | None]] = []
    for row, of_ranks in zip(rows, zip(*distances, strict=True), strict=True):
        names = sorted(set().union(*of_ranks))
        ranks = {name: _nearest(name, of_ranks) for name in names}
        mine = bodies.comm.rank
        result.append({name: row[name] if ranks[name] == mine else None for name in names})
    return result


def _nearest(name: str, distances: Sequence[Mapping[str, float]]) -> int:
    """Rank with the cell that is nearest to a point; the first of several."""
    return int(np.argmin([each.get(name, np.inf) for each in distances]))


def _in_body(
    body: BodyMesh, index: int, point: np.ndarray, owners: Mapping[str, str]
) -> dict[str, CellPoint]:
    """Cells of one body that contain a point and that this rank owns, by owner."""
    dofmap, mesh = geometry_dofmap(body.mesh), body.mesh
    nodes = mesh.geometry.x[dofmap[: body.n_cells]][..., : mesh.geometry.dim]
    search, found = CellSearch(mesh, degree=1), dict[str, CellPoint]()
    for cell, place, distance in zip(*search.near(nodes, point), strict=True):
        owner = owners[body.names[body.parts_of_cells(np.array([cell]))[0]]]
        closer = owner not in found or distance < found[owner].distance
        if distance <= _INSIDE and closer:
            found[owner] = CellPoint(float(distance), index, int(cell), place)
    return found


def point_rows(spaces: Spaces, points: Sequence[CellPoint | None]) -> sp.csr_matrix:
    """Values of a nodal field at points, as a matrix (n_points, n_owned). Every rank calls.

    Products with the owned values add up to the values at the points over all ranks.
    """
    entries = []
    for row, at in enumerate(points):
        if at is not None:
            space = spaces.each[at.body]
            weights = tabulated(reference_element(space.mesh, spaces.degree), at.place[None])[0, 0]
            nodes = space.dofmap.index_map.local_to_global(space.dofmap.list[at.cell])
            entries.append((row, at.body, nodes, weights))
    rows = sp.lil_matrix((len(points), spaces.owned))
    for row, body, nodes, weights in chain.from_iterable(spaces.comm.allgather(entries)):
        first, end = spaces.each[body].dofmap.index_map.local_range
        own = (nodes >= first) & (nodes < end)
        rows[row, spaces.starts[body] + nodes[own] - first] = weights[own]
    return rows.tocsr()


def transferred(
    values: np.ndarray,
    old: Spaces,
    new: Spaces,
    old_bodies: Bodies,
    new_bodies: Bodies,
) -> tuple[np.ndarray, float]:
    """Interpolate a scalar field to the nodes of another mesh, body by body. Every rank calls.

    Parameters
    ----------
    values : ndarray, shape (n_owned,)
        Nodal values of the field.
    old, new : Spaces
        Spaces of equal degree on meshes of the same cell types.
    old_bodies, new_bodies : Bodies

    Returns
    -------
    values : ndarray, shape (n_owned,)
        Field at the nodes of the new space.
    error : float
        Largest difference of the two fields at a point between the nodes of each new cell.
    """
    parts = zip(
        old.functions(values, "field"), new.each, old_bodies.each, new_bodies.each, strict=True
    )
    found = [_transferred(*each) for each in parts]
    return np.concatenate([values for values, _ in found]), max(error for _, error in found)


def _transferred(
    function: fem.Function, new: fem.FunctionSpace, old_body: BodyMesh, new_body: BodyMesh
) -> tuple[np.ndarray, float]:
    """Interpolate a field to the nodes of another mesh of one body; see `transferred`."""
    old, values = function.function_space, function.x.array
    count, gdim = new.dofmap.index_map.size_local, old.mesh.geometry.dim
    result, stays = np.zeros(count), np.zeros(count, dtype=bool)
    places = new.tabulate_dof_coordinates()[:count, :gdim]
    unchanged = np.array_equal(old.dofmap.list, new.dofmap.list)
    if all(new.mesh.comm.allgather(unchanged)):  # the meshes differ in node positions only
        stays = np.all(places == old.tabulate_dof_coordinates()[:count, :gdim], axis=1)
        result[stays] = values[:count][stays]
    field, cells = CellSearch(old.mesh, old.ufl_element().degree), _gathered(old_body, function)
    nodes = np.flatnonzero(~stays)
    result[nodes] = field.at(cells, places[nodes])
    at, found = field.between_nodes(_gathered(new_body, as_function(new, result, "field")))
    return result, float(np.abs(field.at(cells, at) - found).max(initial=0.0))


def _gathered(body: BodyMesh, function: fem.Function) -> CellValues:
    """Gather the cells of a body and a field in them from all ranks."""
    mesh, count = body.mesh, body.n_cells
    nodes = mesh.geometry.x[geometry_dofmap(mesh)[:count]][..., : mesh.geometry.dim]
    values = function.x.array[function.function_space.dofmap.list[:count]]
    gathered = mesh.comm.allgather((nodes, values))
    return CellValues(*(np.concatenate([part[k] for part in gathered]) for k in (0, 1)))
