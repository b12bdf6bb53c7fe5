"""Transfer between users' dolfinx meshes and the mesh of a model: cells with tags, and fields."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from dolfinx import fem

from ..bulk.spaces import Spaces, basis_element, lagrange_space
from ..compat import coordinate_element, geometry_dofmap
from ..errors import CaseError
from ..geometry.checks.mesh_checks import note_size, oriented
from ..geometry.mesh.curved import curved
from ..geometry.mesh.mixed import AnyMesh, joined
from ..geometry.mesh.nodes import CORNERS, FACETS, boundary, reference_nodes
from ..geometry.mesh.tagged import TaggedMesh, compact
from ..lagrange import equispaced, matching
from ..parallel import on_root
from ..simulation.system.system import System
from .body import MeshBody

_LEVEL = 1e-9
"""Out-of-plane coordinates of a plane mesh, relative to its size."""


@dataclass(frozen=True)
class UserMeshes:
    """Source of the mesh of both bodies, see `model.model.MeshSource`.

    Attributes
    ----------
    checksum : str
    tagged : TaggedMesh or MixedMesh
    bodies : tuple of MeshBody
        The held body first.
    reversed_cells : tuple of (ndarray of bool)
        Mask of the cells of each body, in the order of the user's mesh, with reversed orientation.
    """

    checksum: str
    tagged: AnyMesh = field(compare=False, repr=False)
    bodies: tuple[MeshBody, ...] = field(compare=False, repr=False)
    reversed_cells: tuple[np.ndarray, ...] = field(compare=False, repr=False)
    path: None = None

    def mesh(self, zone) -> AnyMesh:
        return self.tagged

    def expected_zone(self, force, approach, modulus) -> None:
        return None

    def surfaces_of(self, body: MeshBody) -> tuple[str, ...]:
        """Names of the surfaces of a body."""
        return tuple(s for s in self.tagged.surfaces if s.rpartition(":")[0] == body.name)

    def index(self, body: MeshBody) -> int:
        """Index of a body, 0 for the held one."""
        if body not in self.bodies:
            raise CaseError(f"found {body!r}; must be a body of the model")
        return self.bodies.index(body)

    def function(
        self,
        body: MeshBody,
        system: System,
        spaces: Spaces,
        values: np.ndarray,
        name: str,
    ) -> fem.Function:
        """Function on the user's mesh of a body, NaN outside of the body. Every rank calls.

        Nodal values are copied cell by cell: cells have the same nodes in both meshes, apart from
        those whose orientation was reversed.

        Parameters
        ----------
        body : MeshBody
        system : System
        spaces : Spaces
            Spaces on the meshes of the system.
        values : ndarray, shape (n_owned,)
        name : str

        Raises
        ------
        CaseError
            If the body has been remeshed.
        """
        index = self.index(body)
        if system.worn is not None and system.worn.meshed_anew:
            raise CaseError(f"{name}: {body.name!r} has been remeshed; its field has no user mesh")
        turned = self.reversed_cells[index]
        by_cell, space = self._by_cell(index, system, spaces, values)
        nodes = basis_element(space).points
        by_cell[turned] = by_cell[turned][:, matching(nodes[:, ::-1], nodes)]
        return _placed(body, by_cell, spaces.degree, name)

    def _by_cell(
        self, index: int, system: System, spaces: Spaces, values: np.ndarray
    ) -> tuple[np.ndarray, fem.FunctionSpace]:
        """Nodal values of the cells of a body on all ranks, in the order of the tagged mesh.

        Shape (n_cells, nodes_per_cell, components); also a space on cells like these.
        """
        columns = []
        functions = spaces.functions(values, "values")
        for body, function in zip(system.bodies.each, functions, strict=True):
            nodal = function.x.array.reshape(-1, spaces.components)
            columns.append((nodal[function.function_space.dofmap.list[: body.n_cells]],))
        blocks = [block for (block,) in system.comm.bcast(system.bodies.in_file_order(columns))]
        mixed = len(blocks) > 1  # one block for each body
        chosen, before = (index, 0) if mixed else (0, sum(map(len, self.reversed_cells[:index])))
        space = next(
            space
            for body, space in zip(system.bodies.each, spaces.each, strict=True)
            if body.block == chosen
        )
        return blocks[chosen][before : before + len(self.reversed_cells[index])], space


@dataclass(frozen=True)
class _Piece:
    """Mesh of one body: cells with their parts, and tagged facets by their corners."""

    name: str
    kind: str
    order: int
    points: np.ndarray
    cells: np.ndarray
    parts: np.ndarray
    corners: np.ndarray
    tags: np.ndarray


def user_meshes(bodies: tuple[MeshBody, ...]) -> UserMeshes:
    """Gather the meshes of the bodies, body 1 (held) first. Every rank calls.

    Raises
    ------
    CaseError
        If a mesh is not supported, or invalid.
    """
    pieces = [_gathered(body) for body in bodies]
    smooth = [name for body in bodies for name in body.smooth]

    def gathered() -> tuple[str, AnyMesh, tuple[np.ndarray, ...]]:
        checked = [_oriented(_in_model(piece)) for piece in pieces if piece is not None]
        pairs = zip(checked, bodies, strict=True)
        tagged = joined([_tagged(piece, body) for (piece, _), body in pairs])
        tagged = curved(tagged, smooth, "Body.curved") if smooth else tagged
        note_size(tagged, "Body.mesh", "unit of length")
        return tagged.checksum(), tagged, tuple(turned for _, turned in checked)

    checksum, tagged, reversed_cells = on_root(bodies[0].mesh.comm, gathered)
    return UserMeshes(checksum, tagged, bodies, reversed_cells)


def _gathered(body: MeshBody) -> _Piece | None:
    """Piece of a body on rank 0, as in its mesh, None elsewhere. Every rank calls."""
    mesh = body.mesh
    kind, order = mesh.topology.cell_name(), coordinate_element(mesh).degree
    if kind not in FACETS:
        raise CaseError(
            f"Body {body.name!r}: has cells of type {kind}; supported are {', '.join(FACETS)}"
        )
    parts = body.part_of_cells()
    own = np.flatnonzero(parts >= 0)
    dofs, nodes = geometry_dofmap(mesh), mesh.geometry.index_map()
    corners = _corners(mesh, dofs, body.facets.indices)
    cells, ends = (
        nodes.local_to_global(local.ravel()).reshape(local.shape) for local in (dofs[own], corners)
    )
    points = mesh.geometry.x[: nodes.size_local]
    found = mesh.comm.gather((points, cells, parts[own], ends, body.facets.values))
    if found is None:
        return None
    columns = (np.concatenate(each) for each in zip(*found, strict=True))
    return _Piece(body.name, kind, order, *columns)


def _in_model(piece: _Piece) -> _Piece:
    """Piece with points in its section, or in space, and nodes of the cells in gmsh's order."""
    name, points, kind = f"Body {piece.name!r}", piece.points, piece.kind
    if not len(piece.cells):
        raise CaseError(f"{name}: has no cells")
    if kind in CORNERS:
        if np.ptp(points[:, 2]) > _LEVEL * np.ptp(points, axis=0).max():
            raise CaseError(f"{name}: the mesh of a section must lie in a plane z = const")
        points = points[:, :2]
    nodes, in_gmsh = equispaced(kind, piece.order).points, np.empty_like(piece.cells)
    in_gmsh[:, matching(nodes, reference_nodes(kind, piece.order))] = piece.cells
    return replace(piece, points=points, cells=in_gmsh)


def _corners(mesh, dofs: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """Local geometry nodes at the vertices of facets, shape (n_facets, n_vertices)."""
    topology, tdim = mesh.topology, mesh.topology.dim
    topology.create_connectivity(tdim - 1, 0)
    vertices = topology.connectivity(tdim, 0).array
    node = np.zeros(vertices.max(initial=0) + 1, dtype=dofs.dtype)
    node[vertices] = dofs[:, : len(vertices) // max(len(dofs), 1)].ravel()
    ends = topology.connectivity(tdim - 1, 0)
    per_facet = len(ends.array) // max(ends.num_nodes, 1)
    return node[ends.array.reshape(-1, per_facet)[facets]]


def _oriented(piece: _Piece) -> tuple[_Piece, np.ndarray]:
    """Piece with its cells counter-clockwise, and mask of the reversed ones."""
    if piece.kind not in CORNERS:
        return piece, np.zeros(len(piece.cells), dtype=bool)
    try:
        cells = oriented(piece.points, piece.cells, piece.kind, piece.order, piece.name)
    except CaseError as error:
        raise CaseError(f"Body: {str(error).removeprefix('geometry.path: ')}") from None
    return replace(piece, cells=cells), np.any(cells != piece.cells, axis=1)


def _tagged(piece: _Piece, body: MeshBody) -> TaggedMesh:
    """Tagged mesh of one body."""
    facets, of_facet = _surfaces(piece)
    surfaces = tuple(dict.fromkeys(of_facet))
    return compact(
        TaggedMesh(
            points=piece.points,
            cell_type=piece.kind,
            cells=piece.cells,
            cell_tags=(piece.parts + 1).astype(np.int32),
            facets=facets,
            facet_tags=np.array([surfaces.index(name) + 1 for name in of_facet], dtype=np.int32),
            bodies=tuple(body.parts),
            surfaces=surfaces,
        )
    )


def _surfaces(piece: _Piece) -> tuple[np.ndarray, list[str]]:
    """Nodes of the tagged facets on the boundary of a body, and the name of each."""
    facets = boundary(piece.kind, piece.order, piece.cells.astype(np.int64))
    own = np.sort(facets[:, : piece.corners.shape[1]], axis=1)
    every = np.concatenate([own, np.sort(piece.corners, axis=1)])
    _, label = np.unique(every, axis=0, return_inverse=True)
    label = label.ravel()
    index = np.full(label.max() + 1, -1)
    index[label[len(own) :]] = np.arange(len(piece.tags))
    named = index[label[: len(own)]]
    tagged = np.flatnonzero(named >= 0)
    tagged = tagged[np.argsort(piece.tags[named[tagged]], kind="stable")]
    return facets[tagged], [f"{piece.name}:{tag}" for tag in piece.tags[named[tagged]]]


def _placed(body: MeshBody, by_cell: np.ndarray, degree: int, name: str) -> fem.Function:
    """Function on a user's mesh from nodal values of the body's cells, in their global order."""
    mesh, components = body.mesh, by_cell.shape[2]
    cells = mesh.topology.index_map(mesh.topology.dim)
    number = cells.local_to_global(np.arange(cells.size_local + cells.num_ghosts, dtype=np.int32))
    own = number[np.flatnonzero(body.part_of_cells() >= 0)]
    row = np.full(cells.size_global, -1)
    row[np.concatenate(mesh.comm.allgather(own))] = np.arange(len(by_cell))
    local = np.flatnonzero(row[number] >= 0)
    width = 0 if components == 1 else mesh.geometry.dim
    space = lagrange_space(mesh, degree, width)
    result = fem.Function(space, name=name)
    nodal = np.full((len(result.x.array) // max(width, 1), max(width, 1)), np.nan)
    dofs = space.dofmap.list[local]
    nodal[dofs] = 0.0  # out of plane, in a section embedded in space
    nodal[dofs, :components] = by_cell[row[number[local]]]
    result.x.array[:] = nodal.ravel()
    result.x.scatter_forward()
    return result
