"""Context manager for gmsh models, and their conversion to a tagged mesh."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from ...interrupts import DeferredSignals
from .tagged import TaggedMesh

_CELL_TYPES = {3: "quadrilateral", 10: "quadrilateral", 36: "quadrilateral"} | {
    2: "triangle",
    9: "triangle",
    21: "triangle",
}
"""gmsh's numbers of plane cells of order 1, 2 and 3."""


@contextmanager
def gmsh_model(name: str) -> Iterator:
    """Open a silent gmsh session with one empty model and close it afterwards.

    Ctrl-C and SIGTERM are delivered at its end, as gmsh is called by ctypes.
    """
    import gmsh

    with DeferredSignals():
        gmsh.initialize(["-noenv"], interruptible=False)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.model.add(name)
            yield gmsh
        finally:
            gmsh.finalize()


def tagged_mesh(model, bodies: tuple[str, ...], surfaces: tuple[str, ...]) -> TaggedMesh:
    """Read the physical groups of a meshed plane gmsh model.

    Parameters
    ----------
    model : gmsh.model
        Meshed model, with physical surfaces named as `bodies` and physical curves named as
        `surfaces`.
    bodies, surfaces : tuple of str
        Names, in the order of their tags.
    """
    groups = {(dim, model.getPhysicalName(dim, tag)): tag for dim, tag in model.getPhysicalGroups()}
    cells, cell_tags, cell_type = _elements(model, 2, [groups[2, name] for name in bodies])
    facets, facet_tags, _ = _elements(model, 1, [groups[1, name] for name in surfaces])
    tags, coordinates, _ = model.mesh.getNodes()
    points = coordinates.reshape(-1, 3)[:, :2]
    position = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    position[tags.astype(np.int64)] = np.arange(len(tags))
    used, compact = np.unique(position[cells], return_inverse=True)
    renumber = np.full(len(points), -1, dtype=np.int64)
    renumber[used] = np.arange(len(used))
    return TaggedMesh(
        points=np.ascontiguousarray(points[used]),
        cell_type=_CELL_TYPES[cell_type],
        cells=compact.reshape(cells.shape).astype(np.int64),
        cell_tags=cell_tags,
        facets=renumber[position[facets]],
        facet_tags=facet_tags,
        bodies=bodies,
        surfaces=surfaces,
    )


def _elements(model, dim: int, physical: list[int]) -> tuple[np.ndarray, np.ndarray, int]:
    """Node tags of all elements of the physical groups, index of the group, and gmsh's type."""
    nodes, marks, kinds = [], [], set()
    for mark, group in enumerate(physical, start=1):
        for entity in model.getEntitiesForPhysicalGroup(dim, group):
            for kind, tags, connectivity in zip(*model.mesh.getElements(dim, entity), strict=True):
                kinds.add(int(kind))
                nodes.append(connectivity.reshape(len(tags), -1).astype(np.int64))
                marks.append(np.full(len(tags), mark, dtype=np.int32))
    if len(kinds) != 1:
        raise ValueError(f"expected one element type of dimension {dim}, found gmsh types {kinds}")
    return np.vstack(nodes), np.concatenate(marks), kinds.pop()
