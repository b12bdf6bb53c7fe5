"""Nodes of plane cells of any order, numbered as gmsh does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .tagged import TaggedMesh

CORNERS = {"triangle": 3, "quadrilateral": 4}
_PLACES = {
    "triangle": np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    "quadrilateral": np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
}


def reference_nodes(cell_type: str, order: int) -> np.ndarray:
    """Places of the nodes on the triangle or square of unit sides, shape (n_nodes, 2)."""
    corners = _PLACES[cell_type]
    if order == 0:
        return corners.mean(axis=0, keepdims=True)
    steps = np.arange(1, order)[:, None] / order
    sides = [a + steps * (b - a) for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)]
    nodes = np.concatenate([corners, *sides])
    inner = order - (3 if cell_type == "triangle" else 2)
    if inner < 0:
        return nodes
    shrunk = 1 / order + inner / order * reference_nodes(cell_type, inner)
    return np.concatenate([nodes, shrunk if inner else corners.mean(axis=0, keepdims=True)])


def edge_nodes(cell_type: str, order: int) -> np.ndarray:
    """Nodes of each edge: first, last, then those between; shape (n_edges, order + 1)."""
    n = CORNERS[cell_type]
    side = np.arange(n)[:, None]
    between = n + side * (order - 1) + np.arange(order - 1)
    return np.hstack([side, (side + 1) % n, between])


def boundary(cell_type: str, order: int, cells: np.ndarray) -> np.ndarray:
    """Nodes of the edges that only one cell has, in gmsh's order, shape (n_edges, order + 1)."""
    every = cells[:, edge_nodes(cell_type, order)].reshape(-1, order + 1)
    _, index, count = np.unique(
        np.sort(every[:, :2], axis=1), axis=0, return_inverse=True, return_counts=True
    )
    return every[count[index.ravel()] == 1]


def turned(cell_type: str, order: int) -> np.ndarray:
    """Nodes in the order that turns a cell the other way round."""
    nodes = reference_nodes(cell_type, order)
    return np.array([np.abs(nodes - p[::-1]).sum(axis=1).argmin() for p in nodes])


def order_of(mesh: TaggedMesh) -> int:
    """Geometric order of a mesh."""
    return mesh.facets.shape[1] - 1


def shape_functions(cell_type: str, order: int, points: np.ndarray) -> np.ndarray:
    """Values of the Lagrange polynomials at points of shape (n, 2), shape (n, n_nodes)."""
    return _monomials(cell_type, order, points) @ np.linalg.inv(
        _monomials(cell_type, order, reference_nodes(cell_type, order))
    )


def _monomials(cell_type: str, order: int, points: np.ndarray) -> np.ndarray:
    n = range(order + 1)
    powers = [(i, j) for i in n for j in n if cell_type == "quadrilateral" or i + j <= order]
    return np.stack([points[:, 0] ** i * points[:, 1] ** j for i, j in powers], axis=1)


def quadratic(mesh: TaggedMesh) -> TaggedMesh:
    """The mesh with cells of order 2 whose nodes lie on those of a higher order."""
    kind, order = mesh.cell_type, order_of(mesh)
    n = CORNERS[kind]
    values = shape_functions(kind, order, reference_nodes(kind, 2))
    places = np.einsum("qk,nki->nqi", values, mesh.points[mesh.cells])
    pairs = np.sort(mesh.cells[:, edge_nodes(kind, 1)].reshape(-1, 2), axis=1)
    edges, first, edge = np.unique(pairs, axis=0, return_index=True, return_inverse=True)
    middle = len(mesh.points) + edge.reshape(len(mesh.cells), n)
    centre = len(mesh.points) + len(edges) + np.arange(len(mesh.cells))[:, None]
    cells = np.hstack([mesh.cells[:, :n], middle] + ([centre] if n == 4 else []))
    middles, centres = (part.reshape(-1, 2) for part in (places[:, n : 2 * n], places[:, 2 * n :]))
    points = np.concatenate([mesh.points, middles[first], centres])
    number = {tuple(pair): i for i, pair in enumerate(edges.tolist(), start=len(mesh.points))}
    on = [number[tuple(sorted(pair))] for pair in mesh.facets[:, :2].tolist()]
    facets = np.column_stack([mesh.facets[:, :2], np.array(on, dtype=np.int64)])
    return compact(replace(mesh, points=points, cells=cells, facets=facets))


def compact(mesh: TaggedMesh) -> TaggedMesh:
    """The mesh without points that no cell has."""
    used, cells = np.unique(mesh.cells, return_inverse=True)
    number = np.full(len(mesh.points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return replace(
        mesh,
        points=np.ascontiguousarray(mesh.points[used]),
        cells=cells.reshape(mesh.cells.shape).astype(np.int64),
        facets=number[mesh.facets],
    )
