"""Quality measures of cells of any order, and integrals over them."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .nodes import reference_nodes
from .orders import shape_functions, slopes
from .tagged import TaggedMesh

_PLACES = {2: 7, 3: 4}
"""Points along each side of a plane or spatial cell at which its Jacobian is evaluated."""
_AT_ONCE = 500
"""Number of cells whose matrices are computed together."""


def scaled_jacobians(mesh: TaggedMesh) -> np.ndarray:
    """Scaled Jacobian: smallest determinant of the unit tangents along the grid lines of each cell.

    In the plane the sine of the angle between them; negative if a cell is inverted. Shape
    (n_cells,).
    """
    dim = mesh.points.shape[1]
    places = np.array(list(itertools.product(np.linspace(0, 1, _PLACES[dim]), repeat=dim)))
    if mesh.cell_type == "triangle":
        places = places[places.sum(axis=1) < 1.01]
    nodes = mesh.points[mesh.cells]
    tangents = _combined(slopes(mesh.cell_type, mesh.order, places), nodes)
    lengths = np.sqrt(np.einsum("cqdi,cqdi->cqd", tangents, tangents))
    return (_determinants(tangents) / lengths.prod(axis=2)).min(axis=1)


def quality(mesh: TaggedMesh, parts: tuple[str, ...]) -> float:
    """Smallest scaled Jacobian of some parts of a mesh; -1 if cells have degenerated."""
    of_parts = np.isin(mesh.cell_tags, [mesh.bodies.index(part) + 1 for part in parts])
    found = scaled_jacobians(replace(mesh, cells=mesh.cells[of_parts]))
    return float(np.nan_to_num(found, nan=-1.0).min())


def volume(
    mesh: TaggedMesh, cells: np.ndarray, factor: Callable[[np.ndarray], np.ndarray]
) -> float:
    """Volume of plane cells, with a factor from area to volume at points of shape (n, 2).

    `cells` as in `stiffness`.
    """
    places, weights = gauss_rule(mesh.cell_type, mesh.order + 2)
    nodes = mesh.points[mesh.cells[cells]]
    tangents = _combined(slopes(mesh.cell_type, mesh.order, places), nodes)
    values = shape_functions(mesh.cell_type, mesh.order, places)
    points = np.einsum("qk,cki->cqi", values, nodes)
    areas = np.abs(_determinants(tangents)) * weights
    return float(areas.ravel() @ factor(points.reshape(-1, 2)))


def stiffness(mesh: TaggedMesh, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Matrices of ``∫ grad u·grad v`` of cells, and their indices in the global matrix.

    Parameters
    ----------
    mesh : TaggedMesh
    cells : ndarray of bool, shape (n_cells,)
        Mask of the cells.

    Returns
    -------
    matrices : ndarray, shape (n, nodes_per_cell, nodes_per_cell)
    nodes : ndarray of int, shape (n, nodes_per_cell)
    """
    nodes = mesh.cells[cells]
    return laplacians(mesh.cell_type, mesh.order, mesh.points[nodes]), nodes


def laplacians(kind: str, order: int, nodes: np.ndarray) -> np.ndarray:
    """Matrices of ``∫ grad u·grad v`` of cells, including lines and surfaces in space.

    Parameters
    ----------
    kind : str
    order : int
    nodes : ndarray, shape (n, nodes_per_cell, gdim) [m]

    Returns
    -------
    ndarray, shape (n, nodes_per_cell, nodes_per_cell)
    """
    places, weights = gauss_rule(kind, order + 2)
    derivatives = slopes(kind, order, places)
    result = np.empty((len(nodes), derivatives.shape[2], derivatives.shape[2]))
    for first in range(0, len(nodes), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        tangents = _combined(derivatives, nodes[some])
        metric = tangents @ tangents.mT
        sizes = np.sqrt(_determinants(metric)) * weights
        along = (np.linalg.inv(metric) * sizes[..., None, None]) @ derivatives
        shape = len(along), -1, derivatives.shape[2]
        result[some] = derivatives.reshape(shape[1:]).T @ along.reshape(shape)
    return result


def _combined(derivatives: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """Tangents (n, q, d, gdim) of cells from slopes (q, d, k) and nodes (n, k, gdim)."""
    flat = derivatives.reshape(-1, derivatives.shape[2])
    return (flat @ nodes).reshape(len(nodes), *derivatives.shape[:2], nodes.shape[2])


def _determinants(matrices: np.ndarray) -> np.ndarray:
    """Determinants of small matrices (..., d, d); 2 x 2 ones explicitly, faster than by LAPACK."""
    if matrices.shape[-1] != 2:
        return np.linalg.det(matrices)
    (a, b), (c, d) = np.moveaxis(matrices, (-2, -1), (0, 1))
    return a * d - b * c


def gauss_rule(kind: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points and weights of the cell with unit sides."""
    roots, weights = np.polynomial.legendre.leggauss(count)
    dim = reference_nodes(kind, 1).shape[1]
    places = np.array(list(itertools.product((roots + 1) / 2, repeat=dim)))
    sizes = np.prod(list(itertools.product(weights / 2, repeat=dim)), axis=1)
    if kind == "triangle":
        x, y = places.T
        places, sizes = np.column_stack([x, y * (1 - x)]), sizes * (1 - x)
    return places, sizes
