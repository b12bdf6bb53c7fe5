"""Hexahedra on a lattice of three parameters, mapped to space.

Nodes of cells of any order are images of equally spaced parameters, so nodes of a curved
boundary lie on it exactly and the interior ones follow the map.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..mesh.nodes import reference_nodes
from ..mesh.orders import boundary
from .divisions import MOST_HEXAHEDRA, check_count
from .quads import MeshedBody


@dataclass(frozen=True)
class Lattice:
    """Cells in the space of three parameters.

    Attributes
    ----------
    ends : tuple of ndarray
        Element ends along each parameter, increasing.
    place : callable
        Orientation-preserving map from parameters to coordinates, both of shape (..., 3), by
        default the identity [m].
    closed : bool
        True if the second parameter, an angle, is periodic.
    """

    ends: tuple[np.ndarray, np.ndarray, np.ndarray]
    place: Callable[[np.ndarray], np.ndarray] = np.asarray
    closed: bool = False


def mesh_lattice(lattice: Lattice, order: int) -> MeshedBody:
    """Mesh a lattice with cells of an order."""
    check_count(*(len(ends) - 1 for ends in lattice.ends), most=MOST_HEXAHEDRA)
    u, v, w = (_nodes(ends, order) for ends in lattice.ends)
    if lattice.closed:
        v = v[:-1]
    shape = (len(u), len(v), len(w))
    points = lattice.place(np.stack(np.meshgrid(u, v, w, indexing="ij"), axis=-1).reshape(-1, 3))
    first = np.indices([len(ends) - 1 for ends in lattice.ends]).reshape(3, -1, 1) * order
    within = np.rint(order * reference_nodes("hexahedron", order)).astype(np.int64)
    place = first + within.T[:, None]
    place[1] %= len(v)
    cells = np.ravel_multi_index(tuple(place), shape)
    return MeshedBody(points, cells, boundary("hexahedron", order, cells))


def _nodes(ends: np.ndarray, order: int) -> np.ndarray:
    """Parameters of the nodes of a row of elements."""
    within = np.arange(order) / order
    inner = ends[:-1, None] + np.diff(ends)[:, None] * within
    return np.append(inner.ravel(), ends[-1])
