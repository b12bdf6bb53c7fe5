"""Cells of any order: Lagrange nodes numbered as in gmsh, boundary, links, shape functions."""

from __future__ import annotations

from functools import cache

import numpy as np
import scipy

from ...lagrange import equispaced, matching, tabulated

CORNERS = {"triangle": 3, "quadrilateral": 4}
FACETS = {
    "triangle": "interval",
    "quadrilateral": "interval",
    "tetrahedron": "triangle",
    "hexahedron": "quadrilateral",
}
"""Facet type of each cell type."""
_SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
_PLACES = {
    "interval": np.array([[0.0], [1.0]]),
    "triangle": np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    "quadrilateral": _SQUARE,
    "tetrahedron": np.vstack([np.zeros((1, 3)), np.eye(3)]),
    "hexahedron": np.vstack([np.insert(_SQUARE, 2, z, axis=1) for z in (0.0, 1.0)]),
}
_EDGES = {
    "interval": [(0, 1)],
    "triangle": [(0, 1), (1, 2), (2, 0)],
    "quadrilateral": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "tetrahedron": [(0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1)],
    "hexahedron": [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3)]
    + [(2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)],
}
_SPATIAL_FACETS = {
    "tetrahedron": np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (3, 1, 2)]),
    "hexahedron": np.array(
        [(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7)]
    ),
}
"""Corners of the facets of spatial cells, with outward normal by the right-hand rule."""
_INNER = {"triangle": 3, "tetrahedron": 4}
"""Order of a simplex less that of the simplex of its inner nodes; of other cells it is 2."""


def reference_nodes(cell_type: str, order: int) -> np.ndarray:
    """Nodes of the cell with unit sides: corners, then those in edges, in facets, and inside.

    Shape (n_nodes, 1, 2 or 3).
    """
    corners = _PLACES[cell_type]
    if order == 0:
        return corners.mean(axis=0, keepdims=True)
    steps = np.arange(1, order)[:, None] / order
    nodes = [corners]
    nodes += [corners[a] + steps * (corners[b] - corners[a]) for a, b in _EDGES[cell_type]]
    if cell_type in _SPATIAL_FACETS:
        inner = _inner(FACETS[cell_type], order)
        nodes += [_on_facet(corners[facet], inner) for facet in _SPATIAL_FACETS[cell_type]]
    if cell_type != "interval":
        nodes.append(_inner(cell_type, order))
    return np.concatenate(nodes)


def _inner(cell_type: str, order: int) -> np.ndarray:
    """Nodes inside a cell: the nodes of a smaller cell."""
    left = order - _INNER.get(cell_type, 2)
    if left < 0:
        return np.empty((0, _PLACES[cell_type].shape[1]))
    return 1 / order + left / order * reference_nodes(cell_type, left)


def _on_facet(corners: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Points of a facet of a spatial cell at parameters (n, 2)."""
    return corners[0] + t[:, :1] * (corners[1] - corners[0]) + t[:, 1:] * (corners[-1] - corners[0])


def facet_nodes(cell_type: str, order: int) -> np.ndarray:
    """Nodes of each facet of a spatial cell, with outward normal by the right-hand rule.

    Numbered as gmsh triangles or quadrilaterals, shape (n_facets, nodes_per_facet).
    """
    nodes, corners = reference_nodes(cell_type, order), _PLACES[cell_type]
    t = reference_nodes(FACETS[cell_type], order)
    facets = [_on_facet(corners[facet], t) for facet in _SPATIAL_FACETS[cell_type]]
    return matching(np.array(facets), nodes)


def chord_lengths(points: np.ndarray) -> np.ndarray:
    """Lengths along a polygon up to each of its points (n, gdim), shape (n,)."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def edge_nodes(cell_type: str, order: int) -> np.ndarray:
    """Nodes of each edge: first, last, then interior; shape (n_edges, order + 1)."""
    n = CORNERS[cell_type]
    side = np.arange(n)[:, None]
    between = n + side * (order - 1) + np.arange(order - 1)
    return np.hstack([side, (side + 1) % n, between])


def boundary(cell_type: str, order: int, cells: np.ndarray) -> np.ndarray:
    """Nodes of the edges or facets that belong to a single cell, in gmsh's order.

    Shape (n_edges, order + 1) of plane cells, (n_facets, nodes_per_facet) of spatial ones.
    """
    in_space = cell_type in _SPATIAL_FACETS
    local = facet_nodes(cell_type, order) if in_space else edge_nodes(cell_type, order)
    corners = local[:, : len(_PLACES[FACETS[cell_type]])]
    number, count = numbered(cells[:, corners].reshape(-1, corners.shape[1]))
    cell, facet = np.divmod(np.flatnonzero(count[number] == 1), len(local))
    return cells[cell[:, None], local[facet]]


def numbered(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Number each edge or facet, given by corners (n, n_corners), the same ones alike.

    Shape (n,), in lexicographic order of the sorted corners; also how often each number occurs.
    """
    ordered = np.sort(corners, axis=1)
    order = np.lexsort(ordered.T[::-1])
    ordered = ordered[order]
    new = np.ones(len(ordered), dtype=bool)
    new[1:] = np.any(ordered[1:] != ordered[:-1], axis=1)
    number = np.empty(len(ordered), dtype=np.int64)
    number[order] = np.cumsum(new) - 1
    return number, np.bincount(number)


def meeting(corners: np.ndarray) -> np.ndarray:
    """Pairs of indices of edges that occur twice, given by their ends (n, 2); shape (n, 2)."""
    number, count = numbered(corners)
    order = np.argsort(number, kind="stable")
    return order[count[number[order]] == 2].reshape(-1, 2)


def components(links: np.ndarray, count: int) -> np.ndarray:
    """Number of the connected component of each of `count` nodes with links (n, 2), from 0."""
    graph = scipy.sparse.coo_matrix((np.ones(len(links)), links.T), shape=(count, count))
    return scipy.sparse.csgraph.connected_components(graph, directed=False)[1]


def centre(nodes: np.ndarray, corners: int, share: int) -> np.ndarray:
    """Nodes in the middle where the shape functions of serendipity elements imply them, (n, gdim).

    In a face of 8 nodes at half the sum of those in edges less a quarter of that of the corners, in
    a hexahedron of 20 at a quarter of the sum of those in edges less a quarter of that of the
    corners; `share` is 2 or 4.
    """
    return nodes[:, corners:].sum(axis=1) / share - nodes[:, :corners].sum(axis=1) / 4


def turned(cell_type: str, order: int) -> np.ndarray:
    """Permutation of nodes that reverses the orientation of a cell."""
    nodes = reference_nodes(cell_type, order)
    return matching(nodes[:, ::-1], nodes)


def shape_functions(cell_type: str, order: int, points: np.ndarray) -> np.ndarray:
    """Values of the Lagrange polynomials at points of shape (n, dim), shape (n, n_nodes)."""
    return tabulated(equispaced(cell_type, order), points)[0][:, _numbers(cell_type, order)]


def slopes(cell_type: str, order: int, points: np.ndarray) -> np.ndarray:
    """Gradients of the Lagrange polynomials, shape (n, dim, n_nodes)."""
    table = tabulated(equispaced(cell_type, order), points, 1)[1:]
    return np.ascontiguousarray(table[..., _numbers(cell_type, order)].swapaxes(0, 1))


@cache
def _numbers(cell_type: str, order: int) -> np.ndarray:
    """Number of the polynomial of each node, from the order of gmsh to that of basix."""
    return matching(reference_nodes(cell_type, order), equispaced(cell_type, order).points)
