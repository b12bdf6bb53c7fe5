"""Quality measures of cells of any order."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

from .nodes import slopes
from .tagged import TaggedMesh

_PLACES = {2: 7, 3: 4}
"""Points along each side of a plane or spatial cell at which its Jacobian is evaluated."""
_AT_ONCE = 2000
"""Number of cells whose Jacobians are computed together."""


def jacobians(
    cell_type: str, order: int, nodes: np.ndarray, along: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Smallest and largest scaled Jacobian of each cell, and its mean Jacobian determinant.

    The scaled Jacobian is the determinant of the unit tangents along the grid lines of a cell, in
    the plane the sine of the angle between them: negative if a cell is inverted, NaN where a
    tangent vanishes.

    Parameters
    ----------
    cell_type : str
    order : int
    nodes : ndarray, shape (n_cells, nodes_per_cell, gdim) [m]
    along : int
        Number of points along each side of a cell.

    Returns
    -------
    least, most, mean : ndarray, shape (n_cells,)
    """
    derivatives = slopes(cell_type, order, _grid(cell_type, along, nodes.shape[2]))
    flat = derivatives.reshape(-1, derivatives.shape[2])
    result = np.empty((3, len(nodes)))
    for first in range(0, len(nodes), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        tangents = (flat @ nodes[some]).reshape(-1, *derivatives.shape[:2], nodes.shape[2])
        lengths = np.sqrt(np.einsum("cqdi,cqdi->cqd", tangents, tangents)).prod(axis=2)
        determinants = _determinants(tangents)
        with np.errstate(invalid="ignore", divide="ignore"):
            scaled = determinants / lengths
        result[:, some] = scaled.min(axis=1), scaled.max(axis=1), determinants.mean(axis=1)
    return result[0], result[1], result[2]


def scaled_jacobians(mesh: TaggedMesh) -> np.ndarray:
    """Smallest scaled Jacobian of each cell, see `jacobians`, shape (n_cells,)."""
    along = _PLACES[mesh.points.shape[1]]
    return jacobians(mesh.cell_type, mesh.order, mesh.points[mesh.cells], along)[0]


def quality(mesh: TaggedMesh, parts: tuple[str, ...]) -> float:
    """Smallest scaled Jacobian of some parts of a mesh; -1 if cells have degenerated."""
    of_parts = np.isin(mesh.cell_tags, [mesh.bodies.index(part) + 1 for part in parts])
    found = scaled_jacobians(replace(mesh, cells=mesh.cells[of_parts]))
    return float(np.nan_to_num(found, nan=-1.0).min())


def _grid(cell_type: str, along: int, dim: int) -> np.ndarray:
    """Reference points (n, dim) on a grid with `along` points on each side of a cell."""
    places = np.array(list(itertools.product(np.linspace(0.0, 1.0, along), repeat=dim)))
    return places[places.sum(axis=1) <= 1.0 + 1e-9] if cell_type == "triangle" else places


def _determinants(matrices: np.ndarray) -> np.ndarray:
    """Determinants of small matrices (..., d, d); 2 x 2 ones explicitly, faster than by LAPACK."""
    if matrices.shape[-1] != 2:
        return np.linalg.det(matrices)
    (a, b), (c, d) = np.moveaxis(matrices, (-2, -1), (0, 1))
    return a * d - b * c
