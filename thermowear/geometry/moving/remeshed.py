"""Remeshing of a plane body within its worn outline.

The worn face is redivided on a spline through its nodes; all other lines of the body are kept,
and with them its sides, names and zones. Type and order of the cells are unchanged.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...errors import ComputationError
from ..mesh.gmsh_session import gmsh_model
from ..mesh.tagged import TaggedMesh, compact, scaled_jacobians
from .moved import Extension
from .new_face import NewFace, divided
from .skeleton import OutlinePiece, even, skeleton

_ALGORITHMS = (6, 8, 5)
"""gmsh's algorithms: frontal-Delaunay, its variant for quads, Delaunay; the best one varies."""
_FULL_QUADS = 2
"""Recombination algorithm of gmsh: recombine a mesh of double size, then refine it."""
_SMOOTHING = 10


def meshed_anew(
    mesh: TaggedMesh,
    parts: tuple[str, ...],
    face: np.ndarray,
    sizes: np.ndarray,
    factor: Callable[[np.ndarray], np.ndarray],
    extension: Extension,
) -> tuple[TaggedMesh, NewFace]:
    """Remesh a body; only its outline is used, its present cells may be inverted.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of both bodies.
    parts : tuple of str
        Names of the body's parts.
    face : ndarray of int, shape (n_nodes,)
        Nodes of its worn face in order along it.
    sizes : ndarray, shape (n_edges,)
        Requested lengths of the edges of the face [m].
    factor : callable
        Factor from area to volume at points of shape (n, 2); the volume is kept.
    extension : callable
        Factory of harmonic extensions, for the interior nodes of curved cells.

    Raises
    ------
    ComputationError
        If gmsh cannot mesh the body.
    """
    new = divided(mesh.points[face], mesh.order, sizes, factor)
    lines = skeleton(mesh, parts, face)
    (k,) = (number for number, line in enumerate(lines) if line.is_face)
    if lines[k].ends[0] != face[0]:
        lines[k] = lines[k].backwards()
    lines[k] = replace(lines[k], edges=new.edges)
    if mesh.cell_type == "quadrilateral":
        ends = even(lines)
        lines = [line.cut(at) for line, at in zip(lines, ends, strict=True)]
        new = new.cut(lines[k].edges, ends[k])
    if _edges_intersect(lines):  # gmsh would not terminate
        raise ComputationError("remeshing: the worn face intersects other sides of its body")
    found, trouble = [], None
    for algorithm in _ALGORITHMS:
        try:
            body, known, given = _meshed(mesh, parts, lines, algorithm)
            # nodes of lines move to their exact positions, interior nodes follow
            motion = extension(body, body.cell_type, body.cells, known)(given)
            found.append(replace(body, points=body.points + motion))
        except Exception as error:  # gmsh raises plain Exception
            trouble = error
    if not found:
        raise ComputationError(f"remeshing: gmsh could not mesh the worn body: {trouble}")
    best = max(found, key=lambda body: float(scaled_jacobians(body).min()))
    return with_body(mesh, parts, best), new


def _meshed(
    mesh: TaggedMesh, parts: tuple[str, ...], lines: list[OutlinePiece], algorithm: int
) -> tuple[TaggedMesh, np.ndarray, np.ndarray]:
    """Mesh a body within its boundary lines; see `_read`."""
    every = np.concatenate([line.edges.reshape(-1, 2) for line in lines])
    middle, size = every.mean(axis=0), np.ptp(every, axis=0).max()
    scaled = [replace(line, edges=(line.edges - middle) / size) for line in lines]
    tags = [tag for tag in mesh.tags_of(parts) if np.any(mesh.cell_tags == tag)]
    with gmsh_model("worn body") as gmsh:
        gmsh.option.setNumber("Mesh.Algorithm", algorithm)
        gmsh.option.setNumber("Mesh.RecombinationAlgorithm", _FULL_QUADS)
        gmsh.option.setNumber("Mesh.Smoothing", _SMOOTHING)
        gmsh.option.setNumber("Mesh.Renumber", 0)
        model = gmsh.model
        corners = _draw(model, scaled)
        for tag in tags:
            model.geo.addPlaneSurface(_loops(model, lines, tag), tag)
        model.geo.synchronize()
        if mesh.cell_type == "quadrilateral":
            for tag in tags:
                model.mesh.setRecombine(2, tag)
        model.mesh.generate(2)
        model.mesh.setOrder(mesh.order)
        return _read(model, mesh, tags, lines, corners, (middle, size))


def _edges_intersect(lines: list[OutlinePiece]) -> bool:
    """Test whether chords of edges intersect."""
    starts, ends = (np.concatenate([line.edges[:, k] for line in lines]) for k in (0, -1))
    areas = []  # twice those of triangles of segments and points, shape (n_segments, n_points) [m²]
    for points in (starts, ends):
        way, to = (ends - starts)[:, None], points - starts[:, None]
        areas.append(way[..., 0] * to[..., 1] - way[..., 1] * to[..., 0])
    parted = areas[0] * areas[1] < 0.0  # ends of one segment on both sides of another
    return bool(np.any(parted & parted.T))


def _draw(model, lines: list[OutlinePiece]) -> list[np.ndarray]:
    """Add lines and their edges to a gmsh model; returns the node numbers of each line."""
    points = {
        end: line.edges[i, i] for line in lines for i, end in zip((0, -1), line.ends, strict=True)
    }
    number = {point: k for k, point in enumerate(points, start=1)}
    for point, place in points.items():
        tag = number[point]
        model.addDiscreteEntity(0, tag)
        model.mesh.addNodes(0, tag, [tag], [*place, 0.0])
        model.mesh.addElementsByType(tag, 15, [], [tag])
    result, count = [], len(points)
    for tag, line in enumerate(lines, start=1):
        ends = [number[end] for end in line.ends]
        model.addDiscreteEntity(1, tag, ends)
        inner = count + 1 + np.arange(len(line.edges) - 1)
        count += len(inner)
        places = np.pad(line.edges[1:, 0], ((0, 0), (0, 1)))
        model.mesh.addNodes(1, tag, inner, places.ravel())
        along = np.concatenate([ends[:1], inner, ends[1:]])
        model.mesh.addElementsByType(tag, 1, [], np.column_stack([along[:-1], along[1:]]).ravel())
        result.append(along)
    return result


def _loops(model, lines: list[OutlinePiece], tag: int) -> list[int]:
    """Loops of lines around a part, the outer one first."""
    following = {}
    for number, line in enumerate(lines, start=1):
        if tag in line.parts:
            start, end = line.ends if line.parts[tag] else line.ends[::-1]
            following[start] = (number if line.parts[tag] else -number), end
    found = []
    while following:
        start = next(iter(following))
        number, point = following.pop(start)
        loop = [number]
        while point != start:
            number, point = following.pop(point)
            loop.append(number)
        reach = max(np.ptp(lines[abs(k) - 1].edges.reshape(-1, 2), axis=0).max() for k in loop)
        found.append((reach, loop))
    return [model.geo.addCurveLoop(loop) for _, loop in sorted(found, reverse=True)]


def _read(
    model, mesh: TaggedMesh, tags: list[int], lines: list[OutlinePiece], corners, scale
) -> tuple[TaggedMesh, np.ndarray, np.ndarray]:
    """Body as meshed by gmsh.

    Also returns the mask of the nodes of its lines, and their displacements to the exact positions.
    """
    numbers, places, _ = model.mesh.getNodes()
    position = np.full(int(numbers.max()) + 1, -1)
    position[numbers.astype(int)] = np.arange(len(numbers))
    points = scale[0] + scale[1] * places.reshape(-1, 3)[:, :2]
    given, known = np.zeros_like(points), np.zeros(len(points), dtype=bool)
    facets, facet_tags = [], []
    for number, (line, along) in enumerate(zip(lines, corners, strict=True), start=1):
        drawn = _elements(model, 1, number)
        if not np.array_equal(drawn[:, :2], np.column_stack([along[:-1], along[1:]])):
            raise ValueError("gmsh has changed the division of the outline")
        drawn = position[drawn]
        given[drawn] = line.edges[:, [0, -1, *range(1, mesh.order)]] - points[drawn]
        known[drawn] = True
        if line.surface:
            facets.append(drawn)
            facet_tags.append(np.full(len(drawn), line.surface, dtype=np.int32))
    cells = [position[_elements(model, 2, tag)] for tag in tags]
    body = replace(
        mesh,
        points=points,
        cells=np.concatenate(cells),
        cell_tags=np.repeat(tags, [len(of_part) for of_part in cells]).astype(np.int32),
        facets=np.concatenate(facets),
        facet_tags=np.concatenate(facet_tags),
    )
    return body, known, given


def _elements(model, dim: int, tag: int) -> np.ndarray:
    """Nodes of the elements of an entity, which must have a single type."""
    _, elements, nodes = model.mesh.getElements(dim, tag)
    if len(elements) != 1:
        raise ValueError("the cells have several types")
    return nodes[0].reshape(len(elements[0]), -1).astype(np.int64)


def with_body(mesh: TaggedMesh, parts: tuple[str, ...], body: TaggedMesh) -> TaggedMesh:
    """Mesh with a new body in place of the one with these parts."""
    stays = ~np.isin(mesh.cell_tags, mesh.tags_of(parts))
    other = np.zeros(len(mesh.points), dtype=bool)
    other[mesh.cells[stays]] = True
    facets, shift = other[mesh.facets].all(axis=1), len(mesh.points)
    return compact(
        replace(
            mesh,
            points=np.concatenate([mesh.points, body.points]),
            cells=np.concatenate([mesh.cells[stays], body.cells + shift]),
            cell_tags=np.concatenate([mesh.cell_tags[stays], body.cell_tags]),
            facets=np.concatenate([mesh.facets[facets], body.facets + shift]),
            facet_tags=np.concatenate([mesh.facet_tags[facets], body.facet_tags]),
        )
    )
