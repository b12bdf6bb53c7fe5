"""Boundary of bodies in space with the names of its parts, for pictures."""

from __future__ import annotations

import numpy as np

from .mixed import AnyMesh, block_of
from .nodes import FACETS, boundary, numbered

_CORNERS = {"tetrahedron": 4, "hexahedron": 8, "triangle": 3, "quadrilateral": 4}


def outside(mesh: AnyMesh, body: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Straight facets of the boundary of a body in space.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
        Mesh whose bodies have no zones.
    body : str

    Returns
    -------
    points : ndarray, shape (n, 3) [m]
    facets : ndarray of int, shape (n_facets, 3 or 4)
    surface : ndarray of int, shape (n_facets,)
        Index of the named surface of each facet, -1 without a name.
    """
    block = block_of(mesh, body)
    kind = block.cell_type
    cells = block.cells[np.isin(block.cell_tags, block.tags_of([body]))][:, : _CORNERS[kind]]
    facets = boundary(kind, 1, cells)
    named = block.facets[:, : _CORNERS[FACETS[kind]]]
    number, count = numbered(np.concatenate([facets, named]))
    surface = np.full(len(count), -1)
    surface[number[len(facets) :]] = block.facet_tags - 1
    used, local = np.unique(facets, return_inverse=True)
    return block.points[used], local.reshape(facets.shape), surface[number[: len(facets)]]
