"""Tagged meshes made by gmsh, independent of the program's own meshing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermowear.geometry.mesh.tagged import TaggedMesh

_CELL_TYPES = {3: "quadrilateral", 10: "quadrilateral", 36: "quadrilateral"} | {
    2: "triangle",
    9: "triangle",
    21: "triangle",
}
"""gmsh's numbers of plane cells of order 1, 2 and 3."""


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


@dataclass(frozen=True)
class Interval:
    """Interval of a grid direction.

    Attributes
    ----------
    start, end : float [m]
    elements : int
    growth : float
        Size ratio of successive elements, from start to end.
    """

    start: float
    end: float
    elements: int
    growth: float = 1.0


@dataclass(frozen=True)
class Grid:
    """Curves and surfaces of a meshed rectangle in gmsh, by position in the grid.

    Attributes
    ----------
    surfaces : list of int
    bottom, top, left, right : list of int
        Boundary curves, one per interval.
    """

    surfaces: list[int]
    bottom: list[int]
    top: list[int]
    left: list[int]
    right: list[int]


def add_grid(model, columns: list[Interval], rows: list[Interval]) -> Grid:
    """Add a rectangle to a gmsh model, prepared for a structured quadrilateral mesh.

    Parameters
    ----------
    model : gmsh.model
    columns, rows : list of Interval
        Consecutive and ascending; the directions of the first and second coordinate.
    """
    geo = model.geo
    xs = [columns[0].start] + [c.end for c in columns]
    ys = [rows[0].start] + [r.end for r in rows]
    point = [[geo.addPoint(x, y, 0.0) for x in xs] for y in ys]
    along = [
        [_line(geo, point[j][i], point[j][i + 1], columns[i]) for i in range(len(columns))]
        for j in range(len(ys))
    ]
    up = [
        [_line(geo, point[j][i], point[j + 1][i], rows[j]) for i in range(len(xs))]
        for j in range(len(rows))
    ]
    surfaces = []
    for j in range(len(rows)):
        for i in range(len(columns)):
            loop = geo.addCurveLoop([along[j][i], up[j][i + 1], -along[j + 1][i], -up[j][i]])
            surface = geo.addPlaneSurface([loop])
            geo.mesh.setTransfiniteSurface(surface)
            geo.mesh.setRecombine(2, surface)
            surfaces.append(surface)
    return Grid(
        surfaces=surfaces,
        bottom=along[0],
        top=along[-1],
        left=[row[0] for row in up],
        right=[row[-1] for row in up],
    )


def _line(geo, start: int, end: int, interval: Interval) -> int:
    line = geo.addLine(start, end)
    geo.mesh.setTransfiniteCurve(line, interval.elements + 1, "Progression", interval.growth)
    return line
