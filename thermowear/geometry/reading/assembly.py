"""Conversion of the contents of a mesh file to a tagged mesh, by names of bodies and surfaces.

Bodies consist of one or several cell sets of the file, and may have parts by cell sets.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

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
    """Part of the case: its name, its sets in the file, and the key that defines it.

    `body` is the index of the only body it can belong to.
    """

    name: str
    sets: tuple[str, ...]
    key: str
    body: int | None = None

    @property
    def in_file(self) -> str:
        return " + ".join(self.sets)

    def members(self, block: CellBlock) -> np.ndarray:
        """Indices of the elements of a block that are in the sets."""
        found = [block.sets[name] for name in self.sets if name in block.sets]
        return np.unique(np.concatenate([np.empty(0, dtype=np.int64), *found]))

    def cells(self, contents: MeshContents) -> list[tuple[CellBlock, np.ndarray]]:
        """Blocks with plane cells in the sets, and the indices of these cells.

        Raises
        ------
        CaseError
            If the file has no cells of a set.
        """
        plane = [block for block in contents.blocks if block.dim == 2]
        for name in self.sets:
            if not any(len(block.sets.get(name, ())) for block in plane):
                known = ", ".join(contents.names(2)) or "none"
                raise CaseError(
                    f"{self.key}: the file has no cells named {name!r}; one of: {known}"
                )
        return [(block, at) for block in plane if len(at := self.members(block))]


def assemble(contents: MeshContents, bodies: list[Named], surfaces: list[Named]) -> TaggedMesh:
    """Select the cells of the bodies and the edges of the surfaces.

    Raises
    ------
    CaseError
        One line, reported at the key at fault.
    """
    found = [_cells_of(contents, body) for body in bodies]
    points = _plane(contents.points, np.concatenate([block.nodes.ravel() for block in found]))
    shapes = {(block.corners, block.nodes.shape[1]) for block in found}
    _check_one_type("geometry.bodies: different", shapes)
    _check_disjoint(found, bodies)
    ((corners, nodes_per_cell),) = shapes
    kind, order = _TYPES[corners], _ORDERS[corners, nodes_per_cell]
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


def _cells_of(contents: MeshContents, body: Named) -> CellBlock:
    """Cells of a body, in one block."""
    found = body.cells(contents)
    shapes = {(block.corners, block.nodes.shape[1]) for block, _ in found}
    _check_one_type(f"{body.key}: mixed", shapes)
    nodes = np.concatenate([block.nodes[at] for block, at in found])
    shape = shapes.pop()
    if shape not in _ORDERS:
        raise CaseError(f"{body.key}: cells with {shape[1]} nodes are not supported")
    return CellBlock(found[0][0].kind, nodes, {})


def _check_one_type(found: str, shapes: set[tuple[int, int]]) -> None:
    """Reject cells of several numbers of corners and nodes."""
    if len(shapes) > 1:
        kinds = " and ".join(f"{_TYPES.get(c, 'cell')}s of {n} nodes" for c, n in sorted(shapes))
        raise CaseError(f"{found} cell types, {kinds}; only one type is supported")


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
    (name,) = surface.sets
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
    known = sorted({*contents.names(1), *contents.node_sets})
    names = f"one of: {', '.join(known)}" if known else "it names no surface"
    raise CaseError(f"{surface.key}: the file has no surface named {name!r}; {names}")


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
    others = [np.empty(0, dtype=np.int64)]
    for block in contents.blocks:
        if block.dim == 2:
            used = np.concatenate([body.members(block) for body in bodies])
            rest = np.delete(block.nodes, used, axis=0)
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
        body, chosen = bodies[part.body], part.cells(contents)
        every = sum(len(at) for _, at in chosen)
        # in the order of `assemble`
        inside = [np.isin(at, part.members(block)) for block, at in body.cells(contents)]
        cells = starts[part.body] + np.flatnonzero(np.concatenate(inside))
        if len(cells) < every:
            raise CaseError(
                f"{part.key}: {every - len(cells)} of {every} cells of {part.in_file!r} do not lie "
                f"in the body {body.name!r} ({body.in_file})"
            )
        if taken[cells].any():
            other = sets[taken[cells].max() - 1]
            raise CaseError(
                f"{part.key}: {np.count_nonzero(taken[cells])} cells are in both {part.in_file!r} "
                f"and {other.in_file!r}; each cell has one material"
            )
        taken[cells] = number
        tags[cells] = len(mesh.bodies) + number
    names = (*mesh.bodies, *(part.name for part in sets))
    return replace(mesh, cell_tags=tags, bodies=names)
