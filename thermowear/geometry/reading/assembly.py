"""Conversion of the contents of a mesh file to a tagged mesh, by names of bodies and surfaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import CaseError
from ..mesh.nodes import CORNERS, boundary
from ..mesh.tagged import TaggedMesh, compact
from .contents import CellBlock, MeshContents
from .mesh_checks import oriented

_TYPES = {corners: name for name, corners in CORNERS.items()}
_ORDERS = {(3, 3): 1, (3, 6): 2, (3, 10): 3, (4, 4): 1, (4, 8): 2, (4, 9): 2, (4, 16): 3}
"""Geometric order by numbers of corners and nodes."""
_FARTHEST, _SMALLEST = 1e6, 1e-8
"""Largest distance of nodes from the origin, and least size of both bodies [m]."""


@dataclass(frozen=True)
class Named:
    """Part of the case: its name, its name in the file, and the key that defines it.

    `body` is the index of the only body it can belong to.
    """

    name: str
    in_file: str
    key: str
    body: int | None = None


def assemble(contents: MeshContents, bodies: list[Named], surfaces: list[Named]) -> TaggedMesh:
    """Select the cells of the bodies and the edges of the surfaces.

    Raises
    ------
    CaseError
        One line, reported at the key at fault.
    """
    found = [_cells_of(contents, body) for body in bodies]
    points = _plane(contents.points, np.concatenate([block.nodes.ravel() for block in found]))
    _check_one_type(found)
    _check_disjoint(found, bodies)
    corners = found[0].corners
    kind, order = _TYPES[corners], _ORDERS[corners, found[0].nodes.shape[1]]
    points, cells = _with_centre_nodes(points, [block.nodes for block in found], corners)
    # nodes shared by both bodies are duplicated, otherwise the bodies would be tied
    cells = [nodes + i * len(points) for i, nodes in enumerate(cells)]
    points = np.concatenate([points] * len(cells))
    cells = [
        oriented(points, nodes, kind, order, body.name)
        for nodes, body in zip(cells, bodies, strict=True)
    ]
    edges = [boundary(kind, order, nodes) for nodes in cells]
    original = len(points) // len(cells)
    picked = [_edges_of(contents, surface, edges, bodies, original) for surface in surfaces]
    counts = [len(nodes) for nodes in cells], [len(nodes) for nodes in picked]
    tags = [np.repeat(np.arange(len(n), dtype=np.int32) + 1, n) for n in counts]
    return compact(
        TaggedMesh(
            points=points,
            cell_type=kind,
            cells=np.concatenate(cells),
            cell_tags=tags[0],
            facets=np.concatenate(picked),
            facet_tags=tags[1],
            bodies=tuple(body.name for body in bodies),
            surfaces=tuple(surface.name for surface in surfaces),
        )
    )


def _plane(points: np.ndarray, used: np.ndarray) -> np.ndarray:
    """Nodes in the plane, with checks of coordinates and size."""
    places = points[np.unique(used)]
    if not np.isfinite(places).all():
        raise CaseError("geometry.path: the coordinates of some nodes of the bodies are not finite")
    farthest = places[np.unravel_index(np.abs(places).argmax(), places.shape)[0]]
    if np.abs(farthest).max() > _FARTHEST:
        where = ", ".join(f"{x:.6g}" for x in farthest)
        raise CaseError(
            f"geometry.path: a node lies at ({where}) m; nodes may lie up to {_FARTHEST:g} m away "
            "(check geometry.length_unit, the length of 1 in the file)"
        )
    extent = np.ptp(places, axis=0).max(initial=0.0)
    if extent < _SMALLEST:
        raise CaseError(
            f"geometry.path: the bodies have a size of {extent:.3g} m; at least {_SMALLEST:g} m "
            "(check geometry.length_unit, the length of 1 in the file)"
        )
    if points.shape[1] == 3 and np.ptp(places[:, 2]) > 1e-9 * extent:
        raise CaseError("geometry.path: the nodes do not lie in a plane z = const")
    return np.ascontiguousarray(points[:, :2])


def _unknown(part: Named, known: list[str], what: str) -> CaseError:
    names = f"one of: {', '.join(known)}" if known else f"it names no {what}"
    return CaseError(f"{part.key}: the file has no {what} named {part.in_file!r}; {names}")


def _cells_of(contents: MeshContents, body: Named) -> CellBlock:
    """Cells of a body, in one block."""
    blocks = [b for b in contents.blocks if b.dim == 2 and len(b.sets.get(body.in_file, ()))]
    if not blocks:
        raise _unknown(body, contents.names(2), "cells")
    shapes = {(b.corners, b.nodes.shape[1]) for b in blocks}
    if len(shapes) > 1:
        raise CaseError(
            f"{body.key}: mixed cell types, {_describe(shapes)}; only one type is supported"
        )
    nodes = np.concatenate([b.nodes[b.sets[body.in_file]] for b in blocks])
    shape = shapes.pop()
    if shape not in _ORDERS:
        raise CaseError(f"{body.key}: cells with {shape[1]} nodes are not supported")
    return CellBlock(blocks[0].kind, nodes, {})


def _describe(shapes) -> str:
    return " and ".join(f"{_TYPES.get(c, 'cell')}s of {n} nodes" for c, n in sorted(shapes))


def _check_one_type(found: list[CellBlock]) -> None:
    shapes = {(block.corners, block.nodes.shape[1]) for block in found}
    if len(shapes) > 1:
        raise CaseError(
            f"geometry.bodies: different cell types, {_describe(shapes)}; only one type is "
            "supported"
        )


def _check_disjoint(found: list[CellBlock], bodies: list[Named]) -> None:
    """Reject cells that belong to both bodies or occur twice."""
    cells = np.sort(np.concatenate([b.nodes[:, : b.corners] for b in found]), axis=1)
    double = len(cells) - len(np.unique(cells, axis=0))
    if double:
        raise CaseError(
            f"geometry.bodies: {double} cells are in both {bodies[0].in_file!r} and "
            f"{bodies[1].in_file!r}, or twice in one of them"
        )


def _with_centre_nodes(
    points: np.ndarray, cells: list[np.ndarray], corners: int
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Add the centre node of eight-node quadrilaterals, as implied by their shape functions."""
    if corners != 4 or cells[0].shape[1] != 8:
        return points, cells
    result = []
    for nodes in cells:
        x = points[nodes]
        centre = x[:, 4:].sum(axis=1) / 2 - x[:, :4].sum(axis=1) / 4
        result.append(np.column_stack([nodes, len(points) + np.arange(len(nodes))]))
        points = np.concatenate([points, centre])
    return points, result


def _edges_of(
    contents: MeshContents,
    surface: Named,
    edges: list[np.ndarray],
    bodies: list[Named],
    copies: int,
) -> np.ndarray:
    """Boundary edges of a surface; the nodes of body i are those of the file plus i * copies."""
    original = [of_body - i * copies for i, of_body in enumerate(edges)]
    masks = _members(contents, surface, original, bodies)
    allowed = range(len(edges)) if surface.body is None else [surface.body]
    result = np.concatenate([edges[i][masks[i]] for i in allowed])
    if not len(result):
        whose = "a body" if surface.body is None else f"body {bodies[surface.body].name!r}"
        raise CaseError(f"{surface.key}: {surface.in_file!r} is not on the boundary of {whose}")
    return result


def _members(
    contents: MeshContents, surface: Named, edges: list[np.ndarray], bodies: list[Named]
) -> list[np.ndarray]:
    """Masks of the boundary edges of each body on a surface, given by its lines or nodes."""
    name = surface.in_file
    lines = [b.nodes[b.sets[name]] for b in contents.blocks if b.dim == 1 and name in b.sets]
    if lines:
        wanted = [_pairs(part) for part in lines]
        own = [_pairs(of_body[:, :2]).ravel() for of_body in edges]
        _check_lines(contents, surface, wanted, np.concatenate(own), bodies)
        every = np.concatenate([part.ravel() for part in wanted])
        return [np.isin(of_body, every) for of_body in own]
    if name in contents.node_sets:
        nodes = contents.node_sets[name]
        return [np.all(np.isin(of_body, nodes), axis=1) for of_body in edges]
    raise _unknown(surface, sorted({*contents.names(1), *contents.node_sets}), "surface")


def _pairs(nodes: np.ndarray) -> np.ndarray:
    """Unique number of each pair of nodes of lines, shape (n_lines, n_pairs).

    One of them is the pair of end nodes, in whichever order a format lists the nodes.
    """
    one, other = np.triu_indices(nodes.shape[1], 1)
    low, high = (
        np.minimum(nodes[:, one], nodes[:, other]),
        np.maximum(nodes[:, one], nodes[:, other]),
    )
    return high * (high - 1) // 2 + low


def _check_lines(
    contents: MeshContents,
    surface: Named,
    wanted: list[np.ndarray],
    own: np.ndarray,
    bodies: list[Named],
) -> None:
    """Reject a surface with lines off all boundaries; those of further bodies are ignored."""
    lost = [part for lines in wanted for part in lines[~np.isin(lines, own).any(axis=1)]]
    if not lost:
        return
    names = {body.in_file for body in bodies}
    others = [np.empty(0, dtype=np.int64)]
    for block in contents.blocks:
        if block.dim == 2:
            used = [at for name, at in block.sets.items() if name in names]
            rest = np.delete(block.nodes, np.concatenate(used) if used else [], axis=0)
            corners = rest[:, : block.corners]
            ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
            others.append(_pairs(ends).ravel())
    further = np.concatenate(others)
    count = sum(not np.isin(part, further).any() for part in lost)
    if count:
        raise CaseError(
            f"{surface.key}: {count} of {sum(map(len, wanted))} lines of {surface.in_file!r} are "
            "not on the boundary of any body"
        )
