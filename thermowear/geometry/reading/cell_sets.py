"""Bodies of a mesh file that consist of several cell sets, or have parts by cell sets."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...errors import CaseError
from ..mesh.tagged import TaggedMesh
from .assembly import Named
from .contents import CellBlock, MeshContents


def joined(
    contents: MeshContents, bodies: dict[str, tuple[str, ...]]
) -> tuple[MeshContents, list[Named]]:
    """Merge the cell sets of each body; returns the contents and the names of the merged sets.

    Parameters
    ----------
    contents : MeshContents
    bodies : dict of str to tuple of str
        Names of the cell sets of each body.

    Raises
    ------
    CaseError
        If the file has no cells of a set.
    """
    blocks, named = list(contents.blocks), []
    for body, sets in bodies.items():
        key = f"geometry.bodies.{body}"
        for name in sets:
            if _count(blocks, name) == 0:
                known = ", ".join(contents.names(2)) or "none"
                raise CaseError(f"{key}: the file has no cells named {name!r}; one of: {known}")
        union = " + ".join(sets)
        if len(sets) > 1:
            blocks = [_with_union(block, sets, union) for block in blocks]
        named.append(Named(body, union, key))
    return replace(contents, blocks=blocks), named


def divided(
    mesh: TaggedMesh, contents: MeshContents, bodies: list[Named], sets: list[Named]
) -> TaggedMesh:
    """Mesh with cell sets of its bodies as separate parts, listed after the bodies.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of the bodies.
    contents : MeshContents
        Contents of its file.
    bodies, sets : list of Named
        `Named.body` of a set is the body that contains it.

    Raises
    ------
    CaseError
        If a set is unknown, not within its body, or overlaps another one.
    """
    tags, taken = mesh.cell_tags.copy(), np.zeros(len(mesh.cell_tags), dtype=np.int64)
    starts = np.searchsorted(mesh.cell_tags, [1, 2])
    for number, part in enumerate(sets, start=1):
        assert part.body is not None
        every = _count(contents.blocks, part.in_file)
        if every == 0:
            known = ", ".join(contents.names(2))
            raise CaseError(
                f"{part.key}: the file has no cells named {part.in_file!r}; one of: {known}"
            )
        body = bodies[part.body]
        cells = starts[part.body] + np.flatnonzero(_members(contents, body.in_file, part.in_file))
        if len(cells) < every:
            raise CaseError(
                f"{part.key}: {every - len(cells)} of {every} cells of {part.in_file!r} do not lie "
                f"in the body {body.name!r} ({body.in_file})"
            )
        if taken[cells].any():
            other = sets[taken[cells].max() - 1]
            raise CaseError(
                f"{part.key}: {np.count_nonzero(taken[cells])} cells are in both "
                f"{part.in_file!r} and "
                f"{other.in_file!r}; each cell has one material"
            )
        taken[cells] = number
        tags[cells] = len(mesh.bodies) + number
    names = (*mesh.bodies, *(part.name for part in sets))
    return replace(mesh, cell_tags=tags, bodies=names)


def _count(blocks: list[CellBlock], name: str) -> int:
    """Number of plane cells in a set."""
    return sum(len(block.sets.get(name, ())) for block in blocks if block.dim == 2)


def _with_union(block: CellBlock, names: tuple[str, ...], union: str) -> CellBlock:
    found = [block.sets[name] for name in names if name in block.sets]
    if not found:
        return block
    return replace(block, sets=block.sets | {union: np.unique(np.concatenate(found))})


def _members(contents: MeshContents, body: str, name: str) -> np.ndarray:
    """Mask of the cells of a body, in the order of `assemble`, that are in a set."""
    return np.concatenate(
        [
            np.isin(block.sets[body], block.sets.get(name, ()))
            for block in contents.blocks
            if block.dim == 2 and len(block.sets.get(body, ()))
        ]
    )
