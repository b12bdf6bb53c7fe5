"""Shape functions on cells of any order, and how well the cells are shaped."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .nodes import reference_nodes
from .orders import shape_functions
from .tagged import TaggedMesh

_PLACES = 7
"""Along each side of a cell, at which its shape is looked at."""


def slopes(kind: str, order: int, places: np.ndarray) -> np.ndarray:
    """Derivatives of the Lagrange polynomials of a plane cell, shape (n_places, 2, n_nodes)."""
    nodes, powers = reference_nodes(kind, order), _powers(kind, order)
    matrix = np.stack([nodes[:, 0] ** i * nodes[:, 1] ** j for i, j in powers], axis=1)
    x, y = places.T
    along = np.stack([i * x ** max(i - 1, 0) * y**j for i, j in powers], axis=1)
    across = np.stack([j * x**i * y ** max(j - 1, 0) for i, j in powers], axis=1)
    return np.stack([along, across], axis=1) @ np.linalg.inv(matrix)


def scaled_jacobians(mesh: TaggedMesh) -> np.ndarray:
    """Smallest sine of the angle between the grid lines of each plane cell; negative if inverted.

    Shape (n_cells,).
    """
    places = np.array(
        [(x, y) for y in np.linspace(0, 1, _PLACES) for x in np.linspace(0, 1, _PLACES)]
    )
    if mesh.cell_type == "triangle":
        places = places[places.sum(axis=1) < 1.01]
    tangents = np.einsum(
        "qdk,cki->cqdi", slopes(mesh.cell_type, mesh.order, places), mesh.points[mesh.cells]
    )
    lengths = np.linalg.norm(tangents, axis=3).prod(axis=2)
    return (np.linalg.det(tangents) / lengths).min(axis=1)


def volume(
    mesh: TaggedMesh, cells: np.ndarray, factor: Callable[[np.ndarray], np.ndarray]
) -> float:
    """Of plane cells, with a factor from area to volume at points of shape (n, 2).

    `cells` as in `stiffness`.
    """
    places, weights = _rule(mesh.cell_type, mesh.order + 2)
    nodes = mesh.points[mesh.cells[cells]]
    tangents = np.einsum("qdk,cki->cqdi", slopes(mesh.cell_type, mesh.order, places), nodes)
    values = shape_functions(mesh.cell_type, mesh.order, places)
    points = np.einsum("qk,cki->cqi", values, nodes)
    areas = np.abs(np.linalg.det(tangents)) * weights
    return float(areas.ravel() @ factor(points.reshape(-1, 2)))


def stiffness(mesh: TaggedMesh, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Matrices of ``∫ grad u·grad v`` of plane cells, and the integrals' places in the whole.

    Parameters
    ----------
    mesh : TaggedMesh
    cells : ndarray of bool, shape (n_cells,)
        Which of them.

    Returns
    -------
    matrices : ndarray, shape (n, nodes_per_cell, nodes_per_cell)
    nodes : ndarray of int, shape (n, nodes_per_cell)
    """
    places, weights = _rule(mesh.cell_type, mesh.order + 2)
    nodes = mesh.cells[cells]
    derivatives = slopes(mesh.cell_type, mesh.order, places)
    tangents = np.einsum("qdk,cki->cqdi", derivatives, mesh.points[nodes])
    gradients = np.linalg.solve(
        tangents, np.broadcast_to(derivatives, (len(nodes), *derivatives.shape))
    )
    areas = np.abs(np.linalg.det(tangents)) * weights
    return np.einsum("cq,cqik,cqil->ckl", areas, gradients, gradients), nodes


def _powers(kind: str, order: int) -> list[tuple[int, int]]:
    n = range(order + 1)
    return [(i, j) for i in n for j in n if kind != "triangle" or i + j <= order]


def _rule(kind: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points and weights of the cell of unit sides."""
    roots, weights = np.polynomial.legendre.leggauss(count)
    x, y = np.meshgrid((roots + 1) / 2, (roots + 1) / 2, indexing="ij")
    areas = np.outer(weights, weights) / 4
    if kind == "triangle":
        areas, y = areas * (1 - x), y * (1 - x)
    return np.column_stack([x.ravel(), y.ravel()]), areas.ravel()
