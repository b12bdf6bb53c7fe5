"""Facets of a contact face: which ones a rank owns, and the polynomials that curve them."""

from __future__ import annotations

import numpy as np

from ..bulk.bodies import Bodies


def owned_facets(bodies: Bodies, surface: str) -> tuple[np.ndarray, np.ndarray]:
    """Cells of this rank with a facet on a surface, and which of the cell's facets it is.

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


def lagrange(order: int, t: np.ndarray) -> np.ndarray:
    """Lagrange polynomials with equally spaced nodes on [0, 1], shape (n, order + 1)."""
    knots = np.linspace(0.0, 1.0, order + 1)
    values = np.ones((len(t), order + 1))
    for i in range(order + 1):
        for j in np.delete(np.arange(order + 1), i):
            values[:, i] *= (t - knots[j]) / (knots[i] - knots[j])
    return values


def lagrange_slopes(order: int, t: np.ndarray) -> np.ndarray:
    """Their derivatives, shape (n, order + 1)."""
    knots = np.linspace(0.0, 1.0, order + 1)
    slopes = np.zeros((len(t), order + 1))
    for i in range(order + 1):
        others = np.delete(np.arange(order + 1), i)
        for k in others:
            factors = [(t - knots[j]) / (knots[i] - knots[j]) for j in others if j != k]
            slopes[:, i] += np.prod(factors, axis=0) / (knots[i] - knots[k])
    return slopes
