"""Mesh format returned by every geometry and used by all later rooms."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass

import numpy as np

from .nodes import FACETS, reference_nodes


@dataclass(frozen=True)
class TaggedMesh:
    """Two meshed bodies with named parts.

    Cells and facets are listed with the node order of gmsh. Tags are indices into the tuples of
    names, plus one (as gmsh's physical groups).

    Attributes
    ----------
    points : ndarray, shape (n_points, gdim) [m]
    cell_type : str
        ``"quadrilateral"``, ``"triangle"`` or ``"hexahedron"``; the same for all cells.
    cells : ndarray of int64, shape (n_cells, nodes_per_cell)
        Nodes, of any order: curved cells have nodes between their corners.
    cell_tags : ndarray of int32, shape (n_cells,)
    facets : ndarray of int64, shape (n_facets, nodes_per_facet)
        Named boundary facets only.
    facet_tags : ndarray of int32, shape (n_facets,)
    bodies : tuple of str
        Names of the bodies, body 1 (held) first, then those of zones within bodies that have a
        material of their own: the cells of a zone are not tagged with the body.
    surfaces : tuple of str
        Names of the surfaces.
    """

    points: np.ndarray
    cell_type: str
    cells: np.ndarray
    cell_tags: np.ndarray
    facets: np.ndarray
    facet_tags: np.ndarray
    bodies: tuple[str, ...]
    surfaces: tuple[str, ...]

    @property
    def facet_type(self) -> str:
        """``"interval"`` or ``"quadrilateral"``."""
        return FACETS[self.cell_type]

    @property
    def order(self) -> int:
        """Geometric order of the cells."""
        nodes = self.facets.shape[1]
        return (math.isqrt(nodes) if self.facet_type == "quadrilateral" else nodes) - 1

    def checksum(self) -> str:
        """SHA-256 of the mesh, in hexadecimal digits."""
        arrays = (self.points, self.cells, self.cell_tags, self.facets, self.facet_tags)
        found = hashlib.sha256(repr((self.cell_type, self.bodies, self.surfaces)).encode())
        for values in arrays:
            found.update(repr((values.dtype.str, values.shape)).encode())
            found.update(np.ascontiguousarray(values).tobytes())
        return found.hexdigest()

    def node_places(self, kind: str) -> np.ndarray:
        """Reference coordinates of the nodes of a cell or facet, shape (n_nodes, dim)."""
        return reference_nodes(kind, self.order)
