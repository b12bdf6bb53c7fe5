"""Lagrange polynomials, quadrature rules and lattices of reference cells, tabulated by basix.

Cells have unit sides, and kinds by the names of `basix.CellType`.
"""

from __future__ import annotations

from functools import cache
from math import comb

import basix
import numpy as np

_SIDES = {1: "interval", 2: "quadrilateral"}
"""Kind of a facet by its number of parameters."""
_ROUNDING = 1e-14
"""Rounding of tabulated shape functions, which are of the size of 1."""


@cache
def equispaced(kind: str, order: int):
    """Lagrange element of basix with equally spaced nodes, as the cells of meshes have."""
    return basix.create_element(
        basix.ElementFamily.P, basix.CellType[kind], order, basix.LagrangeVariant.equispaced
    )


def tabulated(element, points: np.ndarray, derivatives: int = 0) -> np.ndarray:
    """Shape functions of a scalar element and their derivatives at reference points.

    Parameters
    ----------
    element : basix.finite_element.FiniteElement
    points : ndarray, shape (n, dim)
        May be empty, which basix does not take.
    derivatives : int
        Highest order of the derivatives.

    Returns
    -------
    ndarray, shape (n_derivatives, n, n_nodes)
        Values, first derivatives, then second ones (∂xx, ∂xy, ∂yy in a plane).
    """
    if len(points) == 0:
        return np.empty((comb(points.shape[1] + derivatives, derivatives), 0, element.dim))
    result = element.tabulate(derivatives, points)[..., 0]
    result[np.abs(result) < _ROUNDING] = 0.0  # so that points at nodes on an axis are on it
    return result


def matching(wanted: np.ndarray, listed: np.ndarray) -> np.ndarray:
    """Index in `listed` (m, dim) of each of the `wanted` points (..., dim)."""
    return np.abs(wanted[..., None, :] - listed).sum(axis=-1).argmin(axis=-1)


@cache
def lattice(order: int, dim: int = 1) -> np.ndarray:
    """Equally spaced parameters on a facet, shape (n,) or (n, 2), the last one running fastest."""
    kind = basix.CellType[_SIDES[dim]]
    points = basix.create_lattice(kind, order, basix.LatticeType.equispaced, exterior=True)
    return _parameters(np.asarray(points))[0]


def on_lattice(order: int, t: np.ndarray, derivatives: int = 0) -> np.ndarray:
    """Lagrange polynomials of facets with nodes on a lattice, and their derivatives.

    Parameters
    ----------
    order : int
    t : ndarray, shape (n,) or (n, 2)
        Parameters, one on the edge of a section, two on a quadrilateral.
    derivatives : int
        Highest order of the derivatives.

    Returns
    -------
    ndarray, shape (n_derivatives, n, (order + 1)**dim)
        See `tabulated`; nodes numbered as by `lattice`.
    """
    places = t[:, None] if t.ndim == 1 else t
    element, numbers = _of_facet(order, places.shape[1])
    return tabulated(element, places, derivatives)[..., numbers]


@cache
def _of_facet(order: int, dim: int) -> tuple:
    """Element of a facet, and the number of the polynomial of each node of its lattice."""
    element = equispaced(_SIDES[dim], order)
    return element, matching(lattice(order, dim).reshape(-1, dim), element.points)


@cache
def gauss(count: int, dim: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre rule with `count` points along each side, exact to degree ``2 count - 1``.

    Returns
    -------
    t : ndarray, shape (n,) or (n, 2)
        Parameters of a facet, the last one running fastest.
    weights : ndarray, shape (n,)
    """
    return _rule(dim, 2 * count - 1, basix.QuadratureType.gauss_jacobi)


@cache
def lobatto(count: int, dim: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Lobatto rule with `count` points along each side, exact to degree ``2 count - 3``.

    Both ends of each side are quadrature points. Shapes as of `gauss`.
    """
    if count < 2:
        raise ValueError("a Gauss-Lobatto rule has at least two points")
    return _rule(dim, 2 * count - 3, basix.QuadratureType.gll)


def _rule(dim: int, degree: int, kind: basix.QuadratureType) -> tuple[np.ndarray, np.ndarray]:
    """Quadrature rule of a facet, see `gauss`."""
    cell = basix.CellType[_SIDES[dim]]
    points, weights = map(np.asarray, basix.make_quadrature(cell, degree, rule=kind))
    ends = np.rint(points)  # which basix places up to rounding
    t, order = _parameters(np.where(np.abs(points - ends) < _ROUNDING, ends, points))
    return t, weights[order]


def _parameters(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parameters of points of a facet with the last one running fastest, and their order."""
    order = np.lexsort(points.T[::-1])
    return points[order, 0] if points.shape[1] == 1 else points[order], order
