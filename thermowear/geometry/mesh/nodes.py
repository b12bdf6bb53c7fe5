"""Lagrange nodes of cells of any order, numbered as in gmsh."""

from __future__ import annotations

import numpy as np

from ...lagrange import matching

CORNERS = {"triangle": 3, "quadrilateral": 4}
FACETS = {"triangle": "interval", "quadrilateral": "interval", "hexahedron": "quadrilateral"}
"""Facet type of each cell type."""
_SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
_PLACES = {
    "interval": np.array([[0.0], [1.0]]),
    "triangle": np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    "quadrilateral": _SQUARE,
    "hexahedron": np.vstack([np.insert(_SQUARE, 2, z, axis=1) for z in (0.0, 1.0)]),
}
_HEXAHEDRON_EDGES = np.array(
    [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
)
_HEXAHEDRON_FACETS = np.array(
    [(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7)]
)


def reference_nodes(cell_type: str, order: int) -> np.ndarray:
    """Nodes of the cell with unit sides, shape (n_nodes, 1, 2 or 3)."""
    corners = _PLACES[cell_type]
    if order == 0:
        return corners.mean(axis=0, keepdims=True)
    steps = np.arange(1, order)[:, None] / order
    if cell_type == "interval":
        return np.concatenate([corners, steps])
    if cell_type == "hexahedron":
        return _hexahedron(order, corners, steps)
    sides = [a + steps * (b - a) for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)]
    nodes = np.concatenate([corners, *sides])
    inner = order - (3 if cell_type == "triangle" else 2)
    if inner < 0:
        return nodes
    shrunk = 1 / order + inner / order * reference_nodes(cell_type, inner)
    return np.concatenate([nodes, shrunk if inner else corners.mean(axis=0, keepdims=True)])


def _hexahedron(order: int, corners: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """Nodes of a hexahedron: corners, then those in edges, in facets, in the interior."""
    edges = [corners[a] + steps * (corners[b] - corners[a]) for a, b in _HEXAHEDRON_EDGES]
    if order == 1:
        return corners
    on_facet = _inner("quadrilateral", order)
    facets = [
        corners[a] + on_facet @ np.array([corners[b] - corners[a], corners[d] - corners[a]])
        for a, b, _, d in _HEXAHEDRON_FACETS
    ]
    return np.concatenate([corners, *edges, *facets, _inner("hexahedron", order)])


def _inner(cell_type: str, order: int) -> np.ndarray:
    """Interior nodes of a cell: the nodes of a smaller cell."""
    return 1 / order + (order - 2) / order * reference_nodes(cell_type, order - 2)


def facet_nodes(order: int) -> np.ndarray:
    """Nodes of each facet of a hexahedron, with outward normal by the right-hand rule.

    Numbered as gmsh quadrilaterals, shape (6, (order + 1)²).
    """
    nodes, corners = reference_nodes("hexahedron", order), _PLACES["hexahedron"]
    s, t = reference_nodes("quadrilateral", order).T[..., None]
    a, b, _, d = corners[_HEXAHEDRON_FACETS].swapaxes(0, 1)[:, :, None]
    return matching(a + s * (b - a) + t * (d - a), nodes)


def edge_nodes(cell_type: str, order: int) -> np.ndarray:
    """Nodes of each edge: first, last, then interior; shape (n_edges, order + 1)."""
    n = CORNERS[cell_type]
    side = np.arange(n)[:, None]
    between = n + side * (order - 1) + np.arange(order - 1)
    return np.hstack([side, (side + 1) % n, between])
