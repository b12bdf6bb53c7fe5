"""Distributed dolfinx mesh of one body, with parts and surfaces by name."""

from __future__ import annotations

from dataclasses import dataclass

import dolfinx
import numpy as np
import ufl
from dolfinx import fem

from ..compat import exterior_facet_domain


@dataclass(frozen=True)
class BodyMesh:
    """Distributed mesh of one body; its parts and surfaces are numbered as in the tagged mesh.

    Attributes
    ----------
    mesh : dolfinx.mesh.Mesh
    cell_tags, facet_tags : dolfinx.mesh.MeshTags
        Position of the part, or of the surface, in `names` and `surfaces`, plus one.
    names, surfaces : tuple of str
        Names of the parts and surfaces of all bodies.
    parts : tuple of str
        Names of the parts of this body.
    cell_numbers, point_numbers : ndarray of int or None
        Numbers of the cells and points in the tagged mesh, in the order of creation; None on other
        ranks than 0.
    """

    mesh: dolfinx.mesh.Mesh
    cell_tags: dolfinx.mesh.MeshTags
    facet_tags: dolfinx.mesh.MeshTags
    names: tuple[str, ...]
    surfaces: tuple[str, ...]
    parts: tuple[str, ...]
    cell_numbers: np.ndarray | None
    point_numbers: np.ndarray | None

    @property
    def n_cells(self) -> int:
        """Number of the cells owned by this rank."""
        return self.mesh.topology.index_map(self.mesh.topology.dim).size_local

    def facets(self, surface: str) -> np.ndarray:
        """Local indices of the facets of a surface, ghosts included; none of another body's."""
        return self.facet_tags.find(self.surfaces.index(surface) + 1)

    def cells(self, *parts: str) -> np.ndarray:
        """Local indices of the cells of parts, ghosts included; none of another body's."""
        return np.concatenate([self.cell_tags.find(self.names.index(part) + 1) for part in parts])

    def surface_measure(self, *surfaces: str) -> ufl.Measure:
        """Measure of integration over surfaces; they share the compiled kernels of a form."""
        facets = np.concatenate([self.facets(surface) for surface in surfaces])
        facets = exterior_facet_domain(self.mesh, facets)
        return ufl.Measure("ds", domain=self.mesh, subdomain_data=[(1, facets)])(1)

    def parts_of_cells(self, cells: np.ndarray) -> np.ndarray:
        """Position in `names` of the part (with its own material) of each local cell."""
        tags = self.cell_tags
        return tags.values[np.searchsorted(tags.indices, cells)].astype(np.int64) - 1

    def per_part(self, values: dict[str, float]) -> fem.Function:
        """Piecewise constant function (DG0) with one value per part, zero in the others."""
        space = fem.functionspace(self.mesh, ("Discontinuous Lagrange", 0))
        function = fem.Function(space)
        for name, value in values.items():
            function.x.array[space.dofmap.list[self.cells(name)].ravel()] = value
        return function
