"""Boundary and shape functions of cells of any order; conversion to other orders."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from ...lagrange import equispaced, matching, tabulated
from .nodes import FACETS, edge_nodes, facet_nodes, reference_nodes
from .tagged import TaggedMesh


def boundary(cell_type: str, order: int, cells: np.ndarray) -> np.ndarray:
    """Nodes of the edges or facets that belong to a single cell, in gmsh's order.

    Shape (n_edges, order + 1) of plane cells, (n_facets, (order + 1)²) of hexahedra.
    """
    in_space = cell_type == "hexahedron"
    local = facet_nodes(order) if in_space else edge_nodes(cell_type, order)
    every = cells[:, local].reshape(-1, local.shape[1])
    _, index, count = np.unique(
        np.sort(every[:, : 4 if in_space else 2], axis=1),
        axis=0,
        return_inverse=True,
        return_counts=True,
    )
    return every[count[index.ravel()] == 1]


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


def quadratic(mesh: TaggedMesh) -> TaggedMesh:
    """Mesh with cells of order 2 whose nodes lie on the cells of higher order."""
    kind, order = mesh.cell_type, mesh.order
    values = shape_functions(kind, order, reference_nodes(kind, 2))
    places = np.einsum("qk,cki->cqi", values, mesh.points[mesh.cells])
    keys = [_corner_keys(kind, mesh.cells), _corner_keys(FACETS[kind], mesh.facets)]
    keys[1] = np.pad(
        keys[1], ((0, 0), (keys[0].shape[1] - keys[1].shape[1], 0)), constant_values=-1
    )
    _, first, node = np.unique(np.concatenate(keys), axis=0, return_index=True, return_inverse=True)
    cells, facets = np.split(node.ravel(), [len(keys[0])])
    return replace(
        mesh,
        points=places.reshape(-1, mesh.points.shape[1])[first],
        cells=cells.reshape(len(mesh.cells), -1),
        facets=facets.reshape(len(mesh.facets), -1),
    )


def _corner_keys(kind: str, cells: np.ndarray) -> np.ndarray:
    """Corners between which each node of order 2 lies, padded with -1, sorted; one row per node."""
    belongs = shape_functions(kind, 1, reference_nodes(kind, 2)) > 1e-9
    corners = cells[:, : belongs.shape[1]]
    return np.sort(np.where(belongs, corners[:, None], -1), axis=2).reshape(-1, belongs.shape[1])


def compact(mesh: TaggedMesh) -> TaggedMesh:
    """Mesh without unused points."""
    used, cells = np.unique(mesh.cells, return_inverse=True)
    number = np.full(len(mesh.points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return replace(
        mesh,
        points=np.ascontiguousarray(mesh.points[used]),
        cells=cells.reshape(mesh.cells.shape).astype(np.int64),
        facets=number[mesh.facets],
    )
