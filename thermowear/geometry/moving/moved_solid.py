"""Motion of the boundary of a body in space whose face has moved into it.

Sides that meet the face at an angle slide along themselves up to their next sharp edge, and so do
the edges between them; the rest of the boundary is fixed. All by harmonic extension, first in the
edges, then in the sides; last, in the body, interior nodes follow (`bulk.mesh_motion`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from ...lagrange import gauss
from ..mesh.nodes import FACETS
from ..mesh.orders import shape_functions, slopes
from ..mesh.tagged import TaggedMesh
from .moved import Extension, cells_of, nodes_at
from .patches import Patches


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
    extension : callable
        Factory of harmonic extensions into the edges and sides.
    """

    def __init__(
        self, mesh: TaggedMesh, parts: tuple[str, ...], face: np.ndarray, extension: Extension
    ):
        self._mesh = mesh
        self._extension = extension
        self.face = nodes_at(mesh, parts, face)
        self._patches = Patches(mesh, cells_of(mesh, parts), self.face)

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
        for extended in self._extensions:
            given = extended(given)
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
        kind, order = self._kind, self._mesh.order
        before, after = (_enclosed(kind, order, p) for p in (points, points + outlined[facets]))
        return (before - after) * float(factor(np.zeros((1, 3)))[0])

    @cached_property
    def _extensions(self) -> list[Callable[[np.ndarray], np.ndarray]]:
        """Harmonic extensions into the edges between the sliding sides, then into these sides."""
        known = np.zeros(len(self._mesh.points), dtype=bool)
        known[self._patches.still] = known[self.face] = True
        found = []
        for kind, cells in (("interval", self._patches.seams), (self._kind, self._patches.sliding)):
            if len(cells):
                found.append(self._extension(self._mesh, kind, cells, known.copy()))
                known[cells] = True
        return found

    @property
    def _kind(self) -> str:
        return FACETS[self._mesh.cell_type]


def _enclosed(kind: str, order: int, facets: np.ndarray) -> float:
    """Contribution of facets (n, n_nodes, 3) to ``∮ x·n dS / 3``."""
    places, weights = gauss(2 * order + 1, dim=2)
    points = np.einsum("qk,fki->fqi", shape_functions(kind, order, places), facets)
    tangents = np.einsum("qdk,fki->dfqi", slopes(kind, order, places), facets)
    return float(np.einsum("fqi,fqi,q->", points, np.cross(*tangents), weights)) / 3
