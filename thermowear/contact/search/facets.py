"""Facets of a contact face that a rank owns, and the softness behind them."""

from __future__ import annotations

import numpy as np
from dolfinx import fem

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
