"""Mesh format returned by every geometry and used by all later rooms."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, replace

import numpy as np

from .nodes import FACETS, reference_nodes, shape_functions


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


def quadratic(mesh: TaggedMesh) -> TaggedMesh:
    """Mesh with cells of order 2 whose nodes lie on the cells of higher order."""
    kind, order = mesh.cell_type, mesh.order
    values = shape_functions(kind, order, reference_nodes(kind, 2))
    places = np.einsum("qk,cki->cqi", values, mesh.points[mesh.cells])
    keys = [_corner_keys(kind, mesh.cells), _corner_keys(FACETS[kind], mesh.facets)]
    keys[1] = np.pad(
        keys[1], ((0, 0), (keys[0].shape[1] - keys[1].shape[1], 0)), constant_values=-1
    )
    _, first, node = np.unique(np.concatenate(keys), axis=0, return_index=True, return_inverse=True)
    cells, facets = np.split(node.ravel(), [len(keys[0])])
    return replace(
        mesh,
        points=places.reshape(-1, mesh.points.shape[1])[first],
        cells=cells.reshape(len(mesh.cells), -1),
        facets=facets.reshape(len(mesh.facets), -1),
    )


def _corner_keys(kind: str, cells: np.ndarray) -> np.ndarray:
    """Corners between which each node of order 2 lies, padded with -1, sorted; one row per node."""
    belongs = shape_functions(kind, 1, reference_nodes(kind, 2)) > 1e-9
    corners = cells[:, : belongs.shape[1]]
    return np.sort(np.where(belongs, corners[:, None], -1), axis=2).reshape(-1, belongs.shape[1])


def compact(mesh: TaggedMesh) -> TaggedMesh:
    """Mesh without unused points."""
    used, cells = np.unique(mesh.cells, return_inverse=True)
    number = np.full(len(mesh.points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return replace(
        mesh,
        points=np.ascontiguousarray(mesh.points[used]),
        cells=cells.reshape(mesh.cells.shape).astype(np.int64),
        facets=number[mesh.facets],
    )
