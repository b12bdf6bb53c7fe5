"""Bodies, each in a distributed dolfinx mesh of its own, from a tagged mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import basix
import basix.ufl
import dolfinx
import numpy as np
import scipy.sparse as sp
from dolfinx import io

from ..lagrange import equispaced, matching
from .body_mesh import BodyMesh


@dataclass(frozen=True)
class Bodies:
    """Meshes of the bodies. They know nothing of each other: no node or facet is shared.

    Attributes
    ----------
    each : tuple of BodyMesh
    checksum : str
        Checksum of the tagged mesh that they were made from.
    """

    each: tuple[BodyMesh, ...]
    checksum: str

    @cached_property
    def comm(self):
        return self.each[0].mesh.comm

    @property
    def dim(self) -> int:
        """Dimension of the cells and of the space that they lie in."""
        return self.each[0].mesh.topology.dim

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parts of all bodies."""
        return self.each[0].names

    def index_of(self, surface: str) -> int:
        """Index of the body that a surface belongs to; 0 if it has no facets. Every rank calls."""
        found = [len(body.facets(surface)) > 0 for body in self.each]
        return int(np.argmax(np.any(self.comm.allgather(found), axis=0)))

    def in_file_order(self, columns: Sequence[tuple[np.ndarray, ...]]) -> list[np.ndarray] | None:
        """Gather values by cell on rank 0, in the order of the tagged mesh. Every rank calls.

        Parameters
        ----------
        columns : sequence of tuple of ndarray, shape (n_cells, …)
            For each body: arrays with a row for each cell that this rank owns.

        Returns
        -------
        list of ndarray or None
            One array for each column; None on other ranks than 0.
        """
        parts = []
        for body, values in zip(self.each, columns, strict=True):
            created = body.mesh.topology.original_cell_index[: body.n_cells]
            gathered = self.comm.gather((created, *values), root=0)
            for original, *rest in gathered or ():
                assert body.cell_numbers is not None
                parts.append((body.cell_numbers[original], *rest))
        if not parts:
            return None
        numbers, *joined = (np.concatenate(column) for column in zip(*parts, strict=True))
        order = np.argsort(numbers)
        return [column[order] for column in joined]


def distribute(tagged, comm) -> Bodies:
    """Create the distributed meshes of the bodies from a tagged mesh on rank 0.

    Parameters
    ----------
    tagged : thermowear.geometry.TaggedMesh or None
        Needed on rank 0, ignored elsewhere. Parts that share nodes or surfaces are one body.
    comm : mpi4py.MPI.Comm
        Every rank calls.
    """
    head, groups = None, [np.empty(0, dtype=np.int64)]
    if comm.rank == 0:
        groups = _connected(tagged)
        shape = tagged.cell_type, tagged.facet_type, tagged.order, tagged.points.shape[1]
        head = shape, tagged.bodies, tagged.surfaces, tagged.checksum(), len(groups)
    shape, names, surfaces, checksum, count = comm.bcast(head)
    return Bodies(
        tuple(
            _body(tagged, comm, shape, names, surfaces, groups[k] if comm.rank == 0 else None)
            for k in range(count)
        ),
        checksum,
    )


def _connected(tagged) -> list[np.ndarray]:
    """Tags of the parts of each body: of parts that share nodes, or a surface."""
    n_parts, n_points = len(tagged.bodies), len(tagged.points)
    part = np.repeat(tagged.cell_tags - 1, tagged.cells.shape[1])
    ones = np.ones(len(part), dtype=np.int8)
    at = sp.csr_matrix((ones, (part, tagged.cells.ravel())), (n_parts, n_points)) > 0
    surface = np.repeat(tagged.facet_tags - 1, tagged.facets.shape[1])
    ones = np.ones(len(surface), dtype=np.int8)
    shape = len(tagged.surfaces), n_points
    on = sp.csr_matrix((ones, (surface, tagged.facets.ravel())), shape) > 0
    at, on = at.astype(np.int64), on.astype(np.int64)
    of_surface = at @ on.T
    _, body = sp.csgraph.connected_components(at @ at.T + of_surface @ of_surface.T)
    _, first = np.unique(body, return_index=True)
    return [np.flatnonzero(body == body[k]) + 1 for k in np.sort(first)]


def _body(tagged, comm, shape, names, surfaces, tags: np.ndarray | None) -> BodyMesh:
    """Distributed mesh of the parts with some tags, given on rank 0."""
    kind, facet_kind, order, gdim = shape
    if tags is not None:
        numbers = np.flatnonzero(np.isin(tagged.cell_tags, tags))
        used = np.zeros(len(tagged.points), dtype=bool)
        used[tagged.cells[numbers]] = True
        at, own = np.flatnonzero(used), np.cumsum(used) - 1
        mine = used[tagged.facets].all(axis=1)
        cells = in_dolfinx_order(tagged, kind, own[tagged.cells[numbers]])
        facets = in_dolfinx_order(tagged, facet_kind, own[tagged.facets[mine]])
        points = tagged.points[at]
        cell_tags, facet_tags = tagged.cell_tags[numbers], tagged.facet_tags[mine]
    else:
        numbers, at = None, None
        cells = np.empty((0, equispaced(kind, order).dim), dtype=np.int64)
        facets = np.empty((0, equispaced(facet_kind, order).dim), dtype=np.int64)
        points = np.empty((0, gdim))
        cell_tags, facet_tags = np.empty(0, dtype=np.int32), np.empty(0, dtype=np.int32)
    mesh = created_mesh(comm, kind, order, cells, points)
    tdim = mesh.topology.dim
    present: np.ndarray = comm.bcast(tags)
    return BodyMesh(
        mesh=mesh,
        cell_tags=distributed_tags(mesh, tdim, cells, cell_tags),
        facet_tags=distributed_tags(mesh, tdim - 1, facets, facet_tags),
        names=names,
        surfaces=surfaces,
        parts=tuple(names[tag - 1] for tag in present),
        cell_numbers=numbers,
        point_numbers=at,
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


def distributed_tags(mesh, dim: int, entities: np.ndarray, values: np.ndarray):
    """Tags of cells or facets, by their nodes as when the mesh was created. Every rank calls."""
    mesh.topology.create_connectivity(mesh.topology.dim, dim)
    mesh.topology.create_connectivity(dim, 0)
    mesh.topology.create_connectivity(dim, mesh.topology.dim)
    local, marks = io.utils.distribute_entity_data(mesh, dim, entities, values)
    adjacency = dolfinx.graph.adjacencylist(local)
    return dolfinx.mesh.meshtags_from_entities(mesh, dim, adjacency, marks.astype(np.int32))
