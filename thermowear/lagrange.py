"""Lagrange polynomials, quadrature rules and lattices of reference cells, tabulated by basix.

Cells have unit sides, and kinds by the names of `basix.CellType`.
"""

from __future__ import annotations

import atexit
import math
from functools import cache

import basix
import numpy as np

_ROUNDING = 1e-14
"""Rounding of tabulated shape functions, which are of the size of 1."""

_SAMPLES, _BEYOND_SAMPLES = 40, 1.05
"""Samples along a facet of sums of Lagrange polynomials, and a factor for those between them."""


@cache
def equispaced(kind: str, order: int):
    """Lagrange element of basix with equally spaced nodes, as the cells of meshes have."""
    return basix.create_element(
        basix.ElementFamily.P, basix.CellType[kind], order, basix.LagrangeVariant.equispaced
    )


atexit.register(equispaced.cache_clear)  # basix reports elements that outlive it on the terminal


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
        return np.empty((math.comb(points.shape[1] + derivatives, derivatives), 0, element.dim))
    result = element.tabulate(derivatives, points)[..., 0]
    result[np.abs(result) < _ROUNDING] = 0.0  # so that points at nodes on an axis are on it
    return result


def matching(wanted: np.ndarray, listed: np.ndarray) -> np.ndarray:
    """Index in `listed` (m, dim) of each of the `wanted` points (..., dim)."""
    return np.abs(wanted[..., None, :] - listed).sum(axis=-1).argmin(axis=-1)


def order_of(kind: str, count: int) -> int:
    """Order of a facet with `count` nodes."""
    if kind == "quadrilateral":
        return math.isqrt(count) - 1
    return (math.isqrt(8 * count + 1) - 3) // 2 if kind == "triangle" else count - 1


@cache
def lattice(order: int, kind: str = "interval") -> np.ndarray:
    """Equally spaced parameters on a facet, shape (n,) or (n, 2), the last one running fastest."""
    cell = basix.CellType[kind]
    points = basix.create_lattice(cell, order, basix.LatticeType.equispaced, exterior=True)
    return _parameters(np.asarray(points))[0]


def on_lattice(
    order: int, t: np.ndarray, derivatives: int = 0, kind: str = "interval"
) -> np.ndarray:
    """Lagrange polynomials of facets with nodes on a lattice, and their derivatives.

    Parameters
    ----------
    order : int
    t : ndarray, shape (n,) or (n, dim)
        Parameters.
    derivatives : int
        Highest order of the derivatives.
    kind : str
        ``"interval"`` (the edge of a section), ``"quadrilateral"`` or ``"triangle"``.

    Returns
    -------
    ndarray, shape (n_derivatives, n, n_nodes)
        See `tabulated`; nodes numbered as by `lattice`.
    """
    places = t[:, None] if t.ndim == 1 else t
    element, numbers = _of_facet(order, kind)
    return tabulated(element, places, derivatives)[..., numbers]


@cache
def _of_facet(order: int, kind: str) -> tuple:
    """Element of a facet, and the number of the polynomial of each node of its lattice."""
    element = equispaced(kind, order)
    nodes = lattice(order, kind)
    return element, matching(nodes.reshape(len(nodes), -1), element.points)


@cache
def corner_nodes(order: int, kind: str = "interval") -> np.ndarray:
    """Numbers of the corners among the nodes of `lattice`, shape (n_corners,)."""
    corners, nodes = (lattice(n, kind) for n in (1, order))
    return matching(corners.reshape(len(corners), -1), nodes.reshape(len(nodes), -1))


@cache
def lebesgue(order: int, kind: str) -> float:
    """Bound of polynomials on facets relative to their largest value at the nodes of `lattice`."""
    return _BEYOND_SAMPLES * float(
        np.abs(on_lattice(order, lattice(_SAMPLES, kind), 0, kind)).sum(-1).max()
    )


@cache
def edge_nodes(order: int, kind: str) -> np.ndarray:
    """Numbers of the nodes of `lattice` along each edge of a plane facet, (n_edges, order + 1)."""
    corners, edges = basix.geometry(basix.CellType[kind]), basix.topology(basix.CellType[kind])[1]
    first, last = np.asarray(corners)[np.array(edges)].swapaxes(0, 1)
    part = np.arange(order + 1)[:, None] / order
    return matching(first[:, None] + part * (last - first)[:, None], lattice(order, kind))


@cache
def neighbour_nodes(order: int, kind: str) -> np.ndarray:
    """Pairs of adjacent nodes of `lattice`, shape (n, 2)."""
    nodes = lattice(order, kind).reshape(len(lattice(order, kind)), -1)
    step = np.rint((nodes[None] - nodes[:, None]) * order)
    return np.argwhere((step.sum(axis=2) == 1) & (step.min(axis=2) >= 0))


@cache
def gauss(count: int, kind: str = "interval") -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre rule with `count` points along each side, exact to degree ``2 count - 1``.

    Returns
    -------
    t : ndarray, shape (n,) or (n, 2)
        Parameters of a facet, the last one running fastest.
    weights : ndarray, shape (n,)
    """
    return _rule(kind, 2 * count - 1, basix.QuadratureType.gauss_jacobi)


@cache
def lobatto(count: int, kind: str = "interval") -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Lobatto rule with `count` points along each side, exact to degree ``2 count - 3``.

    Both ends of each side are quadrature points; a triangle has a rule of the same degree without
    them (Xiao and Gimbutas, Comput. Math. Appl. 59 (2010) 663). Shapes as of `gauss`.
    """
    if count < 2:
        raise ValueError("a Gauss-Lobatto rule has at least two points")
    inside = kind == "triangle"
    rule = basix.QuadratureType.default if inside else basix.QuadratureType.gll
    return _rule(kind, 2 * count - 3, rule)


def _rule(kind: str, degree: int, rule: basix.QuadratureType) -> tuple[np.ndarray, np.ndarray]:
    """Quadrature rule of a facet, see `gauss`."""
    cell = basix.CellType[kind]
    points, weights = map(np.asarray, basix.make_quadrature(cell, degree, rule=rule))
    ends = np.rint(points)  # which basix places up to rounding
    t, order = _parameters(np.where(np.abs(points - ends) < _ROUNDING, ends, points))
    return t, weights[order]


def _parameters(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parameters of points of a facet with the last one running fastest, and their order."""
    order = np.lexsort(points.T[::-1])
    return points[order, 0] if points.shape[1] == 1 else points[order], order
