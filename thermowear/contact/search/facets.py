"""Facets of a contact face: owned facets of a rank, and their Lagrange polynomials."""

from __future__ import annotations

from functools import cache

import numpy as np
from dolfinx import fem
from numpy.polynomial.polynomial import polyder

from ...bulk.bodies import Bodies


def owned_facets(bodies: Bodies, surface: str) -> tuple[np.ndarray, np.ndarray]:
    """Cells of this rank with a facet on a surface, and its local facet index.

    Returns
    -------
    cells, local_facets : ndarray of int, shape (n,)
    """
    topology = bodies.mesh.topology
    tdim, fdim = topology.dim, topology.dim - 1
    to_cells = topology.connectivity(fdim, tdim)
    to_facets = topology.connectivity(tdim, fdim)
    facets = bodies.facets(surface)
    cells = np.array([to_cells.links(f)[0] for f in facets], dtype=np.int32)
    mine = cells < topology.index_map(tdim).size_local
    facets, cells = facets[mine], cells[mine]
    local = np.array(
        [np.flatnonzero(to_facets.links(c) == f)[0] for c, f in zip(cells, facets, strict=True)],
        dtype=np.int32,
    )
    return cells, local


def softness_behind(cells: np.ndarray, softness: fem.Function | None) -> np.ndarray:
    """Softness of cells of this rank, by default 1, shape (n,) [1/Pa]."""
    if softness is None:
        return np.ones(len(cells))
    return softness.x.array[softness.function_space.dofmap.list[cells, 0]].astype(float)


def lagrange(order: int, t: np.ndarray) -> np.ndarray:
    """Lagrange polynomials with equally spaced nodes on [0, 1], shape (n, order + 1)."""
    return np.vander(t, order + 1, increasing=True) @ _coefficients(order)


def lagrange_slopes(order: int, t: np.ndarray) -> np.ndarray:
    """First derivatives of the polynomials of `lagrange`, shape (n, order + 1)."""
    return np.vander(t, order, increasing=True) @ _slope_coefficients(order)


def lagrange_bends(order: int, t: np.ndarray) -> np.ndarray:
    """Second derivatives of the polynomials of `lagrange`, shape (n, order + 1)."""
    knots = np.linspace(0.0, 1.0, order + 1)
    return lagrange_slopes(order, t) @ lagrange_slopes(order, knots)


@cache
def _coefficients(order: int) -> np.ndarray:
    """Monomial coefficients of the polynomials: rows by power, columns by node; for low orders."""
    return np.linalg.inv(np.vander(np.linspace(0.0, 1.0, order + 1), increasing=True))


@cache
def _slope_coefficients(order: int) -> np.ndarray:
    """Monomial coefficients of the derivatives, with the same layout."""
    return polyder(_coefficients(order))
