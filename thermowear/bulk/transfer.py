"""Transfer of a field to another mesh of the same bodies, moved slightly or remeshed."""

from __future__ import annotations

from typing import NamedTuple

import basix
import numpy as np
from dolfinx import fem

from ..compat import coordinate_element, geometry_dofmap
from ..lagrange import equispaced, tabulated
from .bodies import Bodies
from .body_mesh import BodyMesh
from .field import as_function, reference_element
from .spaces import Spaces

_MAX_NEWTON_STEPS = 20
_CONTROL_POINT = 0.76
"""Position of the control point, as a fraction of the way from a cell's first corner to its
midpoint."""
_BLOCK_SIZE = 2_000_000
"""Largest number of point-cell pairs searched at once."""
_TOLERANCE = 1e-6
"""Tolerance of the bounding-box search, relative to the size of a cell."""


class _Cells(NamedTuple):
    """Cells of one body from all ranks: geometry nodes (n_cells, n_nodes, gdim), nodal values."""

    nodes: np.ndarray
    values: np.ndarray


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
    field, cells = _Field(old), _gathered(old_body, function)
    nodes = np.flatnonzero(~stays)
    result[nodes] = field.at(cells, places[nodes])
    at, found = field.between_nodes(_gathered(new_body, as_function(new, result, "field")))
    return result, float(np.abs(field.at(cells, at) - found).max(initial=0.0))


class _Field:
    """Evaluation of fields of a space in given cells."""

    def __init__(self, space: fem.FunctionSpace):
        mesh = space.mesh
        self._element = reference_element(mesh, space.ufl_element().degree)
        kind = self._element.cell_type
        self._geometry = equispaced(kind.name, coordinate_element(mesh).degree)
        self._middle = np.asarray(basix.geometry(kind)).mean(axis=0)
        self._simplex = kind in (basix.CellType.triangle, basix.CellType.tetrahedron)

    def between_nodes(self, cells: _Cells) -> tuple[np.ndarray, np.ndarray]:
        """Control point of each cell, not a node for any degree, and the values there."""
        place = _CONTROL_POINT * self._middle[None]
        elements = self._geometry, self._element
        shape, values = (tabulated(element, place)[0, 0] for element in elements)
        return np.einsum("k,cki->ci", shape, cells.nodes), cells.values @ values

    def at(self, cells: _Cells, points: np.ndarray) -> np.ndarray:
        """Values at points, evaluated in the containing (or else the nearest) cell."""
        chunk = max(1, _BLOCK_SIZE // len(cells.nodes))
        parts = [self._at(cells, points[i : i + chunk]) for i in range(0, len(points), chunk)]
        return np.concatenate([np.empty(0), *parts])

    def _at(self, cells: _Cells, points: np.ndarray) -> np.ndarray:
        low, high = cells.nodes.min(axis=1), cells.nodes.max(axis=1)
        room = _TOLERANCE * (high - low).max(axis=1, keepdims=True)
        near = np.ones((len(points), len(low)), dtype=bool)
        for k in range(points.shape[1]):
            near &= points[:, k, None] >= (low - room)[:, k]
            near &= points[:, k, None] <= (high + room)[:, k]
        lost = np.flatnonzero(~near.any(axis=1))
        centres = cells.nodes.mean(axis=1)
        for point in lost:
            near[point, np.linalg.norm(centres - points[point], axis=1).argmin()] = True
        which, cell = np.nonzero(near)
        place = self._places(cells.nodes[cell], points[which])
        inside, outside = self._clipped(place)
        order = np.lexsort((outside, which))
        _, first = np.unique(which[order], return_index=True)
        best = order[first]
        values = tabulated(self._element, inside[best])[0]
        return np.einsum("nk,nk->n", values, cells.values[cell[best]])

    def _places(self, nodes: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Reference coordinates of points in one cell each, by Newton's method."""
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


def _gathered(body: BodyMesh, function: fem.Function) -> _Cells:
    """Gather the cells of a body and a field in them from all ranks."""
    mesh, count = body.mesh, body.n_cells
    nodes = mesh.geometry.x[geometry_dofmap(mesh)[:count]][..., : mesh.geometry.dim]
    values = function.x.array[function.function_space.dofmap.list[:count]]
    gathered = mesh.comm.allgather((nodes, values))
    return _Cells(*(np.concatenate([part[k] for part in gathered]) for k in (0, 1)))
