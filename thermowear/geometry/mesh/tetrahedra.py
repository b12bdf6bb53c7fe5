"""Quality of curved tetrahedra."""

from __future__ import annotations

import itertools
import math
from functools import cache

import numpy as np

from .nodes import slopes

_AT_ONCE = 2000
"""Number of cells evaluated together."""
_CORNERS = np.vstack([np.zeros(3), np.eye(3)])
"""Corners of the reference cell."""
_EDGES = list(itertools.combinations(range(4), 2))
_AT_CORNERS = [[k for k, edge in enumerate(_EDGES) if corner in edge] for corner in range(4)]
"""Edges that meet at each corner."""


def scaled_jacobians(order: int, nodes: np.ndarray) -> np.ndarray:
    """Smallest scaled Jacobian of each tetrahedron, shape (n_cells,).

    ``√2 J / L`` with the determinant J of the map from the reference cell and the largest product L
    of the lengths of three tangents along the edges that meet at a corner: 1 for a regular
    tetrahedron (Knupp, Int. J. Numer. Meth. Engng 48 (2000) 1165). It is sampled on the lattice of
    the polynomial J of degree 3 (order - 1). The Bernstein coefficients of J bound it from below in
    between (Johnen, Remacle, Geuzaine, J. Comput. Phys. 233 (2013) 359): where one of them is not
    positive, the cell may be inverted, and it takes the place of the smallest J.

    Parameters
    ----------
    order : int
    nodes : ndarray, shape (n_cells, nodes_per_cell, 3)
        In gmsh's order [m].
    """
    places, to_bernstein = _lattice(3 * (order - 1))
    derivatives = slopes("tetrahedron", order, places)
    result = np.empty(len(nodes))
    for first in range(0, len(nodes), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        maps = np.einsum("qdk,cki->cqdi", derivatives, nodes[some])
        determinants = np.einsum(
            "cqi,cqi->cq", np.cross(maps[:, :, 0], maps[:, :, 1]), maps[:, :, 2]
        )
        lengths = np.stack(
            [
                np.linalg.norm(np.einsum("d,cqdi->cqi", _CORNERS[b] - _CORNERS[a], maps), axis=2)
                for a, b in _EDGES
            ]
        )
        products = np.max([lengths[edges].prod(axis=0) for edges in _AT_CORNERS], axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            sampled = math.sqrt(2) * (determinants / products).min(axis=1)
            bound = (determinants @ to_bernstein.T).min(axis=1) / products.max(axis=1)
        result[some] = np.where(bound > 0.0, sampled, np.minimum(sampled, math.sqrt(2) * bound))
    return result


@cache
def _lattice(degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Lattice points of polynomials of a degree, and the map from values there to Bernstein's."""
    powers = np.array(
        [p for p in itertools.product(range(degree + 1), repeat=4) if sum(p) == degree]
    )
    places = powers[:, 1:] / max(degree, 1)
    if degree == 0:
        return np.full((1, 3), 0.25), np.ones((1, 1))
    weights = np.column_stack([1 - places.sum(axis=1), places])
    binomials = [math.factorial(degree) / math.prod(map(math.factorial, p)) for p in powers]
    values = np.prod(weights[:, None] ** powers, axis=2) * binomials
    return places, np.linalg.inv(values)
