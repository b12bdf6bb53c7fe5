"""Distributed dolfinx mesh of the bodies, with tags by name."""

from __future__ import annotations

from dataclasses import dataclass

import basix
import basix.ufl
import dolfinx
import numpy as np
import ufl
from dolfinx import fem, io

from ..compat import exterior_facet_domain
from ..lagrange import equispaced, matching


@dataclass(frozen=True)
class Bodies:
    """Distributed mesh with named cells (bodies) and facets (surfaces).

    Attributes
    ----------
    mesh : dolfinx.mesh.Mesh
    cell_tags, facet_tags : dolfinx.mesh.MeshTags
    names : tuple of str
        Names of the bodies; the tag of a body is its position here plus one.
    surfaces : tuple of str
        Names of the surfaces; tags likewise.
    checksum : str
        Checksum of the tagged mesh that they were made from; empty if there is none.
    """

    mesh: dolfinx.mesh.Mesh
    cell_tags: dolfinx.mesh.MeshTags
    facet_tags: dolfinx.mesh.MeshTags
    names: tuple[str, ...]
    surfaces: tuple[str, ...]
    checksum: str = ""

    def body_tag(self, name: str) -> int:
        return self.names.index(name) + 1

    def facets(self, surface: str) -> np.ndarray:
        """Local indices of the facets of a surface, ghosts included."""
        return self.facet_tags.find(self.surfaces.index(surface) + 1)

    def cells(self, *parts: str) -> np.ndarray:
        """Local indices of the cells of parts of bodies, ghosts included."""
        return np.concatenate([self.cell_tags.find(self.body_tag(part)) for part in parts])

    def surface_measure(self, *surfaces: str) -> ufl.Measure:
        """Measure of integration over surfaces; they share the compiled kernels of a form."""
        facets = np.concatenate([self.facets(surface) for surface in surfaces])
        facets = exterior_facet_domain(self.mesh, facets)
        return ufl.Measure("ds", domain=self.mesh, subdomain_data=[(1, facets)])(1)

    def parts_of_cells(self, cells: np.ndarray) -> np.ndarray:
        """Position in `names` of the part (with its own material) of each local cell."""
        tags = self.cell_tags
        return tags.values[np.searchsorted(tags.indices, cells)].astype(np.int64) - 1

    def per_body(self, values: dict[str, float]) -> fem.Function:
        """Piecewise constant function (DG0) with one value per body."""
        space = fem.functionspace(self.mesh, ("Discontinuous Lagrange", 0))
        function = fem.Function(space)
        for name, value in values.items():
            function.x.array[space.dofmap.list[self.cells(name)].ravel()] = value
        return function


def distribute(tagged, comm) -> Bodies:
    """Create the distributed mesh from a tagged mesh on rank 0.

    Parameters
    ----------
    tagged : thermowear.geometry.TaggedMesh or None
        Needed on rank 0, ignored elsewhere.
    comm : mpi4py.MPI.Comm
        Every rank calls.
    """
    head = comm.bcast(
        None
        if comm.rank
        else (
            tagged.cell_type,
            tagged.facet_type,
            tagged.order,
            tagged.points.shape[1],
            tagged.bodies,
            tagged.surfaces,
            tagged.checksum(),
        )
    )
    kind, facet_kind, order, gdim, names, surfaces, checksum = head
    if comm.rank == 0:
        cells = in_dolfinx_order(tagged, kind, tagged.cells)
        facets = in_dolfinx_order(tagged, facet_kind, tagged.facets)
        points, cell_tags, facet_tags = tagged.points, tagged.cell_tags, tagged.facet_tags
    else:
        cells = np.empty((0, equispaced(kind, order).dim), dtype=np.int64)
        facets = np.empty((0, equispaced(facet_kind, order).dim), dtype=np.int64)
        points = np.empty((0, gdim))
        cell_tags, facet_tags = np.empty(0, dtype=np.int32), np.empty(0, dtype=np.int32)
    mesh = created_mesh(comm, kind, order, cells, points)
    tdim = mesh.topology.dim
    return Bodies(
        mesh=mesh,
        cell_tags=_tags(mesh, tdim, cells, cell_tags),
        facet_tags=_tags(mesh, tdim - 1, facets, facet_tags),
        names=names,
        surfaces=surfaces,
        checksum=checksum,
    )


def in_dolfinx_order(tagged, kind: str, cells: np.ndarray) -> np.ndarray:
    """Nodes of cells, facets or edges of a tagged mesh in the order of dolfinx."""
    nodes = equispaced(kind, tagged.order).points
    return cells[:, matching(nodes, tagged.node_places(kind))]


def created_mesh(comm, kind: str, order: int, cells: np.ndarray, points: np.ndarray):
    """Mesh of dolfinx from the nodes of cells in its order. Every rank calls."""
    element = basix.ufl.element(
        "Lagrange",
        kind,
        order,
        shape=points.shape[1:],
        lagrange_variant=basix.LagrangeVariant.equispaced,
    )
    return dolfinx.mesh.create_mesh(comm, cells=cells, x=points, e=element)


def _tags(mesh, dim: int, entities: np.ndarray, values: np.ndarray):
    mesh.topology.create_connectivity(mesh.topology.dim, dim)
    mesh.topology.create_connectivity(dim, 0)
    mesh.topology.create_connectivity(dim, mesh.topology.dim)
    local, marks = io.utils.distribute_entity_data(mesh, dim, entities, values)
    adjacency = dolfinx.graph.adjacencylist(local)
    return dolfinx.mesh.meshtags_from_entities(mesh, dim, adjacency, marks.astype(np.int32))
