"""Bodies, each in a distributed dolfinx mesh of its own, from a tagged mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import basix
import basix.ufl
import dolfinx
import numpy as np
import scipy.sparse as sp
import ufl
from dolfinx import fem, io

from ..compat import exterior_facet_domain
from ..lagrange import equispaced, matching


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
    block : int
        Block of the tagged mesh, of cells of one type and order.
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
    block: int
    cell_numbers: np.ndarray | None
    point_numbers: np.ndarray | None

    @property
    def cell_type(self) -> str:
        """Type of the cells."""
        return self.mesh.topology.cell_name()

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

    def in_file_order(
        self, columns: Sequence[tuple[np.ndarray, ...]]
    ) -> list[list[np.ndarray]] | None:
        """Gather values by cell on rank 0, in the order of the tagged mesh. Every rank calls.

        Parameters
        ----------
        columns : sequence of tuple of ndarray, shape (n_cells, …)
            For each body: arrays with a row for each cell that this rank owns.

        Returns
        -------
        list of list of ndarray, or None
            For each block of the tagged mesh (of one cell type and order) one array for each
            column; None on other ranks than 0.
        """
        parts: dict[int, list] = {body.block: [] for body in self.each}
        for body, values in zip(self.each, columns, strict=True):
            created = body.mesh.topology.original_cell_index[: body.n_cells]
            gathered = self.comm.gather((created, *values), root=0)
            for original, *rest in gathered or ():
                assert body.cell_numbers is not None
                parts[body.block].append((body.cell_numbers[original], *rest))
        if self.comm.rank > 0:
            return None
        return [_sorted(parts[block]) for block in sorted(parts)]


def _sorted(parts: list[tuple[np.ndarray, ...]]) -> list[np.ndarray]:
    """Columns of several tables joined, sorted by the first one, and without it."""
    numbers, *joined = (np.concatenate(column) for column in zip(*parts, strict=True))
    order = np.argsort(numbers)
    return [column[order] for column in joined]


def distribute(tagged, comm) -> Bodies:
    """Create the distributed meshes of the bodies from a tagged mesh on rank 0.

    Parameters
    ----------
    tagged : thermowear.geometry.TaggedMesh, thermowear.geometry.MixedMesh or None
        Needed on rank 0, ignored elsewhere. Parts that share nodes or surfaces are one body, unless
        their cells differ in type or order.
    comm : mpi4py.MPI.Comm
        Every rank calls.
    """
    sources = _bodies_of(tagged) if comm.rank == 0 else []
    head = None
    if comm.rank == 0:
        head = (
            tagged.bodies,
            tagged.surfaces,
            tagged.checksum(),
            [source.head for source in sources],
        )
    names, surfaces, checksum, heads = comm.bcast(head)
    return Bodies(
        tuple(
            _body(sources[k] if sources else None, comm, heads[k], names, surfaces)
            for k in range(len(heads))
        ),
        checksum,
    )


class _CellShape(NamedTuple):
    """Cell type, facet type and order of the cells of a body, its dimension and its block."""

    kind: str
    facet_kind: str
    order: int
    gdim: int
    block: int


@dataclass(frozen=True)
class _SourceBody:
    """Body in a block of a tagged mesh.

    Attributes
    ----------
    tagged : thermowear.geometry.TaggedMesh
        Block of cells of one type and order.
    tags : ndarray of int
        Tags of the parts of the body.
    block, first_cell, first_point : int
        Number of the block, and numbers of its first cell and point in the whole mesh.
    """

    tagged: Any
    tags: np.ndarray
    block: int
    first_cell: int
    first_point: int

    @property
    def head(self) -> _CellShape:
        """Shape of the cells, for ranks without the mesh."""
        of = self.tagged
        return _CellShape(of.cell_type, of.facet_type, of.order, of.points.shape[1], self.block)


def _bodies_of(tagged) -> list[_SourceBody]:
    """Bodies of a tagged mesh, block by block."""
    sources, cell, point = [], 0, 0
    for number, block in enumerate(tagged.blocks):
        present = [np.intersect1d(tags, block.cell_tags) for tags in _connected(block)]
        sources += [_SourceBody(block, tags, number, cell, point) for tags in present if len(tags)]
        cell, point = cell + len(block.cells), point + len(block.points)
    return sources


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


def _body(
    source: _SourceBody | None,
    comm,
    head: _CellShape,
    names: tuple[str, ...],
    surfaces: tuple[str, ...],
) -> BodyMesh:
    """Distributed mesh of a body, given on rank 0."""
    kind, facet_kind, order, gdim, block = head
    if source is not None:
        tagged, tags = source.tagged, source.tags
        numbers = np.flatnonzero(np.isin(tagged.cell_tags, tags))
        used = np.zeros(len(tagged.points), dtype=bool)
        used[tagged.cells[numbers]] = True
        at, own = np.flatnonzero(used), np.cumsum(used) - 1
        mine = used[tagged.facets].all(axis=1)
        cells = in_dolfinx_order(tagged, kind, own[tagged.cells[numbers]])
        facets = in_dolfinx_order(tagged, facet_kind, own[tagged.facets[mine]])
        points = tagged.points[at]
        cell_tags, facet_tags = tagged.cell_tags[numbers], tagged.facet_tags[mine]
        numbers, at = numbers + source.first_cell, at + source.first_point
    else:
        tags, numbers, at = None, None, None
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
        block=block,
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

    def partitioner(_, ranks: int, *__):
        middles = points[cells].mean(axis=1) if len(cells) else np.empty((0, points.shape[1]))
        return dolfinx.graph.adjacencylist(bisected(middles, ranks)[:, None])

    chosen = {"partitioner": partitioner} if comm.size > 1 else {}
    mesh = dolfinx.mesh.create_mesh(comm, cells=cells, x=points, e=element, **chosen)
    # UFL asks for it some ten times a form, and basix makes it each time: a sixth of a short run
    cell = element.cell
    mesh.ufl_domain().ufl_cell = lambda: cell
    return mesh


def bisected(points: np.ndarray, parts: int) -> np.ndarray:
    """Part of each point (n, dim), of equal numbers, by recursive coordinate bisection.

    Berger and Bokhari, IEEE Trans. Comput. C-36 (1987) 570: each set is cut across its longest
    side. Where a mesh comes from one rank, ten times faster than partitioning its graph.
    """
    result = np.zeros(len(points), dtype=np.int32)
    if parts < 2 or not len(points):
        return result
    first = parts // 2
    order = np.argsort(points[:, np.argmax(np.ptp(points, axis=0))], kind="stable")
    lower, upper = np.split(order, [len(points) * first // parts])
    result[lower] = bisected(points[lower], first)
    result[upper] = first + bisected(points[upper], parts - first)
    return result


def distributed_tags(mesh, dim: int, entities: np.ndarray, values: np.ndarray):
    """Tags of cells or facets, by their nodes as when the mesh was created. Every rank calls."""
    mesh.topology.create_connectivity(mesh.topology.dim, dim)
    mesh.topology.create_connectivity(dim, 0)
    mesh.topology.create_connectivity(dim, mesh.topology.dim)
    local, marks = io.utils.distribute_entity_data(mesh, dim, entities, values)
    adjacency = dolfinx.graph.adjacencylist(local)
    return dolfinx.mesh.meshtags_from_entities(mesh, dim, adjacency, marks.astype(np.int32))
