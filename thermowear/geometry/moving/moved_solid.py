"""Mesh motion of a body in space whose face has moved into it.

Sides that meet the face at an angle slide along themselves up to their next sharp edge, and so do
the edges between them; the rest of the boundary is fixed, and the interior nodes follow. All by
harmonic extension: first in the edges, then in the sides, then in the body.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy

from ..mesh.nodes import FACETS
from ..mesh.orders import shape_functions, slopes
from ..mesh.shapes import gauss_rule, laplacians
from ..mesh.tagged import TaggedMesh
from .patches import Patches

_SETTLED = 1e-12
"""Relative residual tolerance of a harmonic extension."""


class MovableSolid:
    """Body of a mesh in space whose worn face can be moved.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of hexahedra.
    parts : tuple of str
        Names of the body's parts.
    face : ndarray, shape (n, 3)
        Coordinates of the nodes of its face [m].
    """

    def __init__(self, mesh: TaggedMesh, parts: tuple[str, ...], face: np.ndarray):
        tags = [mesh.bodies.index(part) + 1 for part in parts]
        self._mesh = mesh
        self._cells = mesh.cells[np.isin(mesh.cell_tags, tags)]
        own = np.unique(self._cells)
        self.face = own[scipy.spatial.cKDTree(mesh.points[own]).query(face)[1]]
        self._patches = Patches(mesh, self._cells, self.face)

    def ways(self, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Outward directions of motion of the nodes of the face, and mask of the fixed ones.

        Nodes where the face ends at a side move along it; fixed where it continues smoothly.

        Parameters
        ----------
        normals : ndarray, shape (n, 3)
            Outward normals at the nodes of the face.

        Returns
        -------
        directions : ndarray, shape (n, 3)
        held : ndarray of bool, shape (n,)
        """
        every = np.zeros_like(self._mesh.points)
        every[self.face] = normals
        nodes, inward = self._patches.inward()
        every[nodes] = -inward
        return every[self.face], np.isin(self.face, self._patches.level())

    def outlined(self, displacement: np.ndarray) -> np.ndarray:
        """Displacement of the outline when the face moves, zero inside; shape (n_points, 3) [m].

        Parameters
        ----------
        displacement : ndarray, shape (n, 3)
            Displacement of the nodes of the face; at its rim along the sides [m].
        """
        given = np.zeros_like(self._mesh.points)
        given[self.face] = displacement
        known = np.zeros(len(given), dtype=bool)
        known[self._patches.still] = known[self.face] = True
        self._extend("interval", self._patches.seams, given, known)
        self._extend("quadrilateral", self._patches.sliding, given, known)
        return given

    def lost(self, outlined: np.ndarray, factor: Callable[[np.ndarray], np.ndarray]) -> float:
        """Volume that the body loses by a displacement of its outline [m³].

        By Gauss's theorem on the moved facets only, as it may be tiny relative to the body's
        volume.

        Parameters
        ----------
        outlined : ndarray, shape (n_points, 3)
            Displacement of the outline, see `outlined` [m].
        factor : callable
            Constant volume factor at points of shape (n, 3).
        """
        facets = self._patches.facets
        facets = facets[np.any(outlined[facets] != 0.0, axis=(1, 2))]
        points = self._mesh.points[facets]
        points = points - points.reshape(-1, 3).mean(axis=0)
        kind, order = FACETS[self._mesh.cell_type], self._mesh.order
        before, after = (_enclosed(kind, order, p) for p in (points, points + outlined[facets]))
        return (before - after) * float(factor(np.zeros((1, 3)))[0])

    def followed(self, outlined: np.ndarray) -> np.ndarray:
        """Coordinates of all nodes of the mesh after the outline has moved, (n_points, 3) [m]."""
        given, known = outlined.copy(), np.zeros(len(outlined), dtype=bool)
        known[self._patches.facets] = True
        self._extend(self._mesh.cell_type, self._cells, given, known)
        return self._mesh.points + given

    def displaced(self, displacement: np.ndarray) -> np.ndarray:
        """Coordinates of all nodes of the mesh after the face has moved, shape (n_points, 3) [m].

        See `outlined` for `displacement`.
        """
        return self.followed(self.outlined(displacement))

    def _extend(self, kind: str, cells: np.ndarray, given: np.ndarray, known: np.ndarray) -> None:
        """Fill in unknown displacements of the nodes of cells by harmonic extension."""
        free = np.unique(cells[~known[cells]])
        if len(free) == 0:
            return
        nodes, place = np.unique(cells, return_inverse=True)
        place = place.reshape(cells.shape)
        matrices = laplacians(kind, self._mesh.order, self._mesh.points[cells])
        size = cells.shape[1]
        where = np.repeat(place, size, axis=1).ravel(), np.tile(place, size).ravel()
        whole = scipy.sparse.coo_matrix(
            (matrices.ravel(), where), shape=(len(nodes), len(nodes))
        ).tocsr()
        rows = whole[np.searchsorted(nodes, free)]
        inner = rows[:, np.searchsorted(nodes, free)]
        right = -(rows @ given[nodes])  # displacements of free nodes are still zero
        scale = 1.0 / inner.diagonal()
        jacobi = scipy.sparse.linalg.LinearOperator(inner.shape, matvec=lambda v: scale * v.ravel())
        for k in range(given.shape[1]):
            given[free, k] = scipy.sparse.linalg.cg(inner, right[:, k], rtol=_SETTLED, M=jacobi)[0]
        known[free] = True


def _enclosed(kind: str, order: int, facets: np.ndarray) -> float:
    """Contribution of facets (n, n_nodes, 3) to ``∮ x·n dS / 3``."""
    places, weights = gauss_rule(kind, 2 * order + 1)
    points = np.einsum("qk,fki->fqi", shape_functions(kind, order, places), facets)
    tangents = np.einsum("qdk,fki->dfqi", slopes(kind, order, places), facets)
    return float(np.einsum("fqi,fqi,q->", points, np.cross(*tangents), weights)) / 3
