"""Mesh of bodies of different cell types or orders, in blocks of equal cells."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .nodes import FACETS, boundary, numbered
from .tagged import TaggedMesh


@dataclass(frozen=True)
class MixedMesh:
    """Meshed bodies of different cell types or orders.

    Points, cells and facets of all blocks are numbered consecutively, block by block.

    Attributes
    ----------
    blocks : tuple of TaggedMesh
        Each with cells of one type and order, without common points; all with the same names of
        bodies and surfaces. A body lies in one block; a surface may have facets in several.
    """

    blocks: tuple[TaggedMesh, ...]

    @property
    def bodies(self) -> tuple[str, ...]:
        """Names of bodies and zones, see `TaggedMesh`."""
        return self.blocks[0].bodies

    @property
    def surfaces(self) -> tuple[str, ...]:
        """Names of the surfaces."""
        return self.blocks[0].surfaces

    @property
    def points(self) -> np.ndarray:
        """Points of all blocks, shape (n_points, gdim) [m]."""
        return np.concatenate([block.points for block in self.blocks])

    @property
    def cell_tags(self) -> np.ndarray:
        """Tags of the cells of all blocks, shape (n_cells,)."""
        return np.concatenate([block.cell_tags for block in self.blocks])

    def checksum(self) -> str:
        """SHA-256 of the mesh, in hexadecimal digits."""
        return hashlib.sha256("".join(b.checksum() for b in self.blocks).encode()).hexdigest()


AnyMesh = TaggedMesh | MixedMesh
"""Mesh of bodies; `blocks` lists its parts of one cell type and order."""


def of_blocks(blocks: Sequence[TaggedMesh]) -> AnyMesh:
    """Mesh of one or several blocks."""
    return blocks[0] if len(blocks) == 1 else MixedMesh(tuple(blocks))


def count_cells(mesh: AnyMesh) -> int:
    """Number of cells."""
    return sum(len(block.cells) for block in mesh.blocks)


def retagged(mesh: AnyMesh, tags: np.ndarray, bodies: tuple[str, ...]) -> AnyMesh:
    """Mesh with other tags of all cells (n_cells,), and the names of bodies that they refer to."""
    parts = np.split(tags, np.cumsum([len(block.cells) for block in mesh.blocks])[:-1])
    pairs = zip(mesh.blocks, parts, strict=True)
    return of_blocks([replace(block, cell_tags=part, bodies=bodies) for block, part in pairs])


def block_with(mesh: AnyMesh, surface: str) -> TaggedMesh:
    """First block with facets of a surface."""
    found = (block for block in mesh.blocks if len(block.facets_of(surface)))
    return next(found, mesh.blocks[0])


def block_of(mesh: AnyMesh, *parts: str) -> TaggedMesh:
    """Block with the cells of a body, given by its parts."""
    tags = [mesh.bodies.index(part) + 1 for part in parts]
    return next((b for b in mesh.blocks if np.isin(b.cell_tags, tags).any()), mesh.blocks[0])


def rows_of(mesh: AnyMesh, block: TaggedMesh) -> slice:
    """Range of the points of a block among those of the mesh."""
    counts = [len(each.points) for each in mesh.blocks]
    before = sum(counts[: next(k for k, each in enumerate(mesh.blocks) if each is block)])
    return slice(before, before + len(block.points))


def placed(mesh: AnyMesh, points: np.ndarray) -> AnyMesh:
    """Mesh with other coordinates of its points (n_points, gdim) [m]."""
    return of_blocks([replace(block, points=points[rows_of(mesh, block)]) for block in mesh.blocks])


def exchanged(mesh: AnyMesh, block: TaggedMesh, new: TaggedMesh) -> AnyMesh:
    """Mesh with a new block in place of another one."""
    return of_blocks([new if each is block else each for each in mesh.blocks])


def joined(meshes: Sequence[TaggedMesh]) -> AnyMesh:
    """Mesh of bodies that were meshed one by one, body 1 first; all names differ.

    One block, or one for each body where their cells differ in type or order.
    """
    bodies = *(mesh.bodies[0] for mesh in meshes), *(z for mesh in meshes for z in mesh.bodies[1:])
    surfaces = tuple(name for mesh in meshes for name in mesh.surfaces)
    renamed = [_renamed(mesh, bodies, surfaces) for mesh in meshes]
    if len({(mesh.cell_type, mesh.order) for mesh in meshes}) > 1:
        return MixedMesh(tuple(renamed))
    starts = np.cumsum([0] + [len(mesh.points) for mesh in meshes])
    pairs = list(zip(renamed, starts, strict=False))
    return replace(
        renamed[0],
        points=np.concatenate([mesh.points for mesh in renamed]),
        cells=np.concatenate([mesh.cells + start for mesh, start in pairs]),
        cell_tags=np.concatenate([mesh.cell_tags for mesh in renamed]),
        facets=np.concatenate([mesh.facets + start for mesh, start in pairs]),
        facet_tags=np.concatenate([mesh.facet_tags for mesh in renamed]),
    )


def _renamed(mesh: TaggedMesh, bodies: tuple[str, ...], surfaces: tuple[str, ...]) -> TaggedMesh:
    """Mesh whose tags refer to longer lists of names."""
    body = np.array([bodies.index(name) + 1 for name in mesh.bodies], dtype=np.int32)
    surface = np.array([surfaces.index(name) + 1 for name in mesh.surfaces], dtype=np.int32)
    return replace(
        mesh,
        cell_tags=body[mesh.cell_tags - 1],
        facet_tags=surface[mesh.facet_tags - 1],
        bodies=bodies,
        surfaces=surfaces,
    )


_CORNERS = {"tetrahedron": 4, "hexahedron": 8, "triangle": 3, "quadrilateral": 4}


def outside(mesh: AnyMesh, body: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Straight facets of the boundary of a body in space.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
        Mesh whose bodies have no zones.
    body : str

    Returns
    -------
    points : ndarray, shape (n, 3) [m]
    facets : ndarray of int, shape (n_facets, 3 or 4)
    surface : ndarray of int, shape (n_facets,)
        Index of the named surface of each facet, -1 without a name.
    """
    block = block_of(mesh, body)
    kind = block.cell_type
    cells = block.cells[np.isin(block.cell_tags, block.tags_of([body]))][:, : _CORNERS[kind]]
    facets = boundary(kind, 1, cells)
    named = block.facets[:, : _CORNERS[FACETS[kind]]]
    number, count = numbered(np.concatenate([facets, named]))
    surface = np.full(len(count), -1)
    surface[number[len(facets) :]] = block.facet_tags - 1
    used, local = np.unique(facets, return_inverse=True)
    return block.points[used], local.reshape(facets.shape), surface[number[: len(facets)]]
