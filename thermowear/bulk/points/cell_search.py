"""Cells that contain given points, and fields there."""

from __future__ import annotations

from typing import NamedTuple

import basix
import numpy as np

from ...compat import coordinate_element
from ...lagrange import equispaced, tabulated
from ..field import reference_element

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
