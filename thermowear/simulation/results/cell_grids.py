"""Grids of points in cells, at which fields of the bodies are recorded."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import permutations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ...bulk.bodies import Bodies
from ...compat import coordinate_element

_SMOOTH, _DRAWN_CELLS = 6, 325_000
"""Number of parts of the side of a curved cell that looks smooth; parts of all cells up to which
cells are divided more finely than their fields need."""


def divisions(bodies: Bodies, least: int) -> int:
    """Number of parts of each side of a cell: more in space where few curved cells look angular."""
    meshes = [body.mesh for body in bodies.each]
    if bodies.dim < 3 or all(coordinate_element(mesh).degree == 1 for mesh in meshes):
        return least
    cells = sum(mesh.topology.index_map(3).size_global for mesh in meshes)
    fine = int((_DRAWN_CELLS / max(cells, 1)) ** (1 / 3))
    return max(least, min(fine, _SMOOTH))


def _grid(n: int, dim: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of an (n + 1)ᵈ grid on the unit cell, and the corners of its small cells."""
    axes = np.meshgrid(*[np.linspace(0.0, 1.0, n + 1)] * dim, indexing="ij")
    points = np.column_stack([axis.ravel() for axis in axes[::-1]])
    numbers = np.arange(len(points)).reshape(axes[0].shape)
    return points, sliding_window_view(numbers, (2,) * dim).reshape(-1, 2**dim)


def _box(n: int, dim: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of a grid on a reference cell, and its small cells in the order of VTK."""
    points, corners = _grid(n, dim)
    return points, corners[:, [0, 1, 3, 2, 4, 5, 7, 6][: 2**dim]]


def _triangle(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of a regular grid on the reference triangle, and its small triangles."""
    points, corners = _grid(n, 2)
    inside = points.sum(axis=1) < 1 + 0.5 / n
    halves = np.vstack([corners[:, [0, 1, 2]], corners[:, [1, 3, 2]]])
    return points[inside], (np.cumsum(inside) - 1)[halves[inside[halves].all(axis=1)]]


def _tetrahedron(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of a regular grid on the reference tetrahedron, and its small tetrahedra.

    Boxes are divided along their diagonals (Kuhn), as is the tetrahedron ``x >= y >= z`` of them.
    """
    points, _ = _grid(n, 3)
    inside: np.ndarray = np.all(np.diff(points, axis=1) <= 0.5 / n, axis=1)
    numbers = np.arange(len(points)).reshape((n + 1,) * 3).transpose()  # by x, y, z
    cells = []
    for axes in permutations(np.eye(3, dtype=int)):
        corners = np.cumsum(np.array([np.zeros(3, dtype=int), *axes]), axis=0)
        boxes = np.moveaxis(np.indices((n,) * 3), 0, -1).reshape(-1, 1, 3) + corners
        cells.append(numbers[tuple(np.moveaxis(boxes, -1, 0))])
    small = np.concatenate(cells)
    small = (np.cumsum(inside) - 1)[small[inside[small].all(axis=1)]]
    x, y, z = points[inside].T
    points = np.column_stack([x - y, y - z, z])
    edges = points[small[:, 1:]] - points[small[:, :1]]
    reversed_ = np.linalg.det(edges) < 0
    small[reversed_, 1:3] = small[reversed_, 2:0:-1]
    return points, small


GRIDS: dict[str, Callable[[int], tuple[np.ndarray, np.ndarray]]] = {
    "quadrilateral": partial(_box, dim=2),
    "triangle": _triangle,
    "hexahedron": partial(_box, dim=3),
    "tetrahedron": _tetrahedron,
}
