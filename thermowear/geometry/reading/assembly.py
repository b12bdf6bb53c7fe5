"""Conversion of the contents of mesh files to a tagged mesh of named bodies.

Bodies consist of one or several cell sets of the file, and may have parts by cell sets.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...errors import CaseError
from ..checks.mesh_checks import oriented
from ..checks.solid_checks import oriented_solid
from ..mesh.curved import curved
from ..mesh.mixed import AnyMesh, of_blocks, retagged
from ..mesh.nodes import boundary, centre, facet_nodes, numbered
from ..mesh.tagged import TaggedMesh, compact
from .contents import TYPES, CellBlock, MeshContents, Named, facets_of, joined
from .file_contents import read_contents

_ORDERS = {
    "triangle": {3: 1, 6: 2, 10: 3},
    "quadrilateral": {4: 1, 8: 2, 9: 2, 16: 3},
    "tetrahedron": {4: 1, 10: 2, 20: 3},
    "hexahedron": {8: 1, 20: 2, 27: 2, 64: 3},
}
"""Geometric order by cell type and number of nodes."""
_PLURALS = {"tetrahedron": "tetrahedra", "hexahedron": "hexahedra"}
_FARTHEST, _SMALLEST = 1e6, 1e-8
"""Largest distance of nodes from the origin, and least size of all bodies [m]."""


def assemble(contents: MeshContents, bodies: list[Named], surfaces: list[Named]) -> AnyMesh:
    """Select the cells of the bodies and the edges or facets of the surfaces.

    The mesh has one block, or one for each body where their types or orders differ.

    Raises
    ------
    CaseError
        One line, reported at the key at fault.
    """
    found = [_cells_of(contents, body) for body in bodies]
    used = np.zeros(len(contents.points), dtype=bool)
    for block in found:
        used[block.nodes] = True
    points = _placed(contents, used)
    _check_disjoint(found, bodies)
    kinds = [TYPES[contents.dim][block.corners] for block in found]
    shapes = [
        (kind, _ORDERS[kind][block.nodes.shape[1]])
        for kind, block in zip(kinds, found, strict=True)
    ]
    cells = []
    for kind, block in zip(kinds, found, strict=True):
        points, nodes = with_inner_nodes(points, block.nodes, kind)
        cells.append(nodes)
    # nodes shared by several bodies are duplicated, otherwise the bodies would be tied
    original = len(points)
    cells = [nodes + i * original for i, nodes in enumerate(cells)]
    points = np.concatenate([points] * len(cells))
    checked = [
        _oriented(points, nodes, *shape, body.name)
        for nodes, shape, body in zip(cells, shapes, bodies, strict=True)
    ]
    facets = [boundary_ for _, boundary_ in checked]
    picked = [facets_of(contents, surface, facets, bodies, original) for surface in surfaces]
    names = tuple(body.name for body in bodies), tuple(surface.name for surface in surfaces)
    every = list(range(len(bodies)))
    blocks = [every] if len(set(shapes)) == 1 else [[i] for i in every]
    return of_blocks(
        [
            _block(points, shapes[of[0]][0], {i: checked[i][0] for i in of}, picked, *names)
            for of in blocks
        ]
    )


def _block(
    points: np.ndarray,
    kind: str,
    cells: dict[int, np.ndarray],
    picked: list[list[np.ndarray]],
    bodies: tuple[str, ...],
    surfaces: tuple[str, ...],
) -> TaggedMesh:
    """Mesh of the bodies with cells of one type and order.

    Parameters
    ----------
    points : ndarray, shape (n, gdim) [m]
    kind : str
    cells : dict of int to ndarray
        Cells by index of the body.
    picked : list of list of ndarray
        Facets of each surface that belong to each body.
    bodies, surfaces : tuple of str
        All names.
    """
    facets = [np.concatenate([of_surface[i] for i in cells]) for of_surface in picked]
    tags = [
        np.repeat(np.array(numbers, dtype=np.int32) + 1, [len(nodes) for nodes in groups])
        for numbers, groups in ((list(cells), cells.values()), (range(len(facets)), facets))
    ]
    return compact(
        TaggedMesh(
            points=points,
            cell_type=kind,
            cells=np.concatenate(list(cells.values())),
            cell_tags=tags[0],
            facets=np.concatenate(facets),
            facet_tags=tags[1],
            bodies=bodies,
            surfaces=surfaces,
        )
    )


def _oriented(
    points: np.ndarray, cells: np.ndarray, kind: str, order: int, body: str
) -> tuple[np.ndarray, np.ndarray]:
    """Checked cells of a body with det J > 0, and its boundary."""
    if points.shape[1] == 3:
        return oriented_solid(points, cells, kind, order, body)
    cells = oriented(points, cells, kind, order, body)
    return cells, boundary(kind, order, cells)


def _placed(contents: MeshContents, used: np.ndarray) -> np.ndarray:
    """Nodes in the plane or in space, with checks of coordinates and size."""
    points = contents.points
    places = points[used]
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
    in_plane = contents.dim == 2
    if in_plane and points.shape[1] == 3 and np.ptp(places[:, 2]) > 1e-9 * extent:
        raise CaseError("geometry.path: the nodes do not lie in a plane z = const")
    return np.ascontiguousarray(points[:, : contents.dim])


def _cells_of(contents: MeshContents, body: Named) -> CellBlock:
    """Cells of a body, in one block."""
    found = body.cells(contents)
    shapes = {(block.corners, block.nodes.shape[1]) for block, _ in found}
    _check_one_type(f"{body.key}: mixed", shapes, contents.dim)
    nodes = np.concatenate([block.nodes[at] for block, at in found])
    ((corners, count),) = shapes
    if count not in _ORDERS[TYPES[contents.dim][corners]]:
        raise CaseError(f"{body.key}: cells with {count} nodes are not supported")
    return CellBlock(found[0][0].kind, nodes, {})


def _check_one_type(found: str, shapes: set[tuple[int, int]], dim: int) -> None:
    """Reject cells of several numbers of corners and nodes."""
    if len(shapes) > 1:
        names = [(TYPES[dim].get(corners, "cell"), nodes) for corners, nodes in sorted(shapes)]
        kinds = " and ".join(f"{_PLURALS.get(name, name + 's')} of {n} nodes" for name, n in names)
        raise CaseError(f"{found} cell types, {kinds}; only one type is supported")


def _check_disjoint(found: list[CellBlock], bodies: list[Named]) -> None:
    """Reject cells that belong to several bodies or occur twice."""
    double, owners = 0, set[int]()
    for corners in {block.corners for block in found}:
        alike = [i for i, block in enumerate(found) if block.corners == corners]
        nodes = [found[i].nodes[:, :corners] for i in alike]
        number, count = numbered(np.concatenate(nodes))
        owner = np.repeat(alike, [len(of) for of in nodes])
        double += int((count - 1).sum())
        owners |= set(owner[count[number] > 1].tolist())
    if double:
        *others, last = (bodies[i].in_file for i in sorted(owners))
        if not others:
            raise CaseError(f"geometry.bodies: {double} cells occur twice in {last!r}")
        raise CaseError(
            f"geometry.bodies: {double} cells are in both {', '.join(map(repr, others))} and "
            f"{last!r}, or twice in one of them"
        )


def with_inner_nodes(
    points: np.ndarray, nodes: np.ndarray, kind: str
) -> tuple[np.ndarray, np.ndarray]:
    """Add the nodes inside faces and cells that serendipity elements lack, see `nodes.centre`."""
    if (kind, nodes.shape[1]) not in (("quadrilateral", 8), ("hexahedron", 20)):
        return points, nodes
    cells_of, corners, share = nodes, 4, 2
    if kind == "hexahedron":
        on_face = facet_nodes(kind, 2)[:, :8]
        faces = nodes[:, on_face].reshape(-1, 8)
        number, _ = numbered(faces[:, :4])
        _, first = np.unique(number, return_index=True)
        nodes = np.column_stack([nodes, (len(points) + number).reshape(-1, 6)])
        points = np.concatenate([points, centre(points[faces[first]], 4, 2)])
        cells_of, corners, share = nodes[:, :20], 8, 4
    centres = centre(points[cells_of], corners, share)
    nodes = np.column_stack([nodes, len(points) + np.arange(len(nodes))])
    return np.concatenate([points, centres]), nodes


def divided(
    mesh: AnyMesh, contents: MeshContents, bodies: list[Named], sets: list[Named]
) -> AnyMesh:
    """Mesh with cell sets of its bodies as separate parts, listed after the bodies.

    Parameters
    ----------
    mesh : TaggedMesh or MixedMesh
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
    starts = np.searchsorted(mesh.cell_tags, np.arange(len(bodies)) + 1)
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
    return retagged(mesh, tags, names)


def read_bodies(
    path: str | None,
    paths: Mapping[str, str],
    dim: int,
    length_unit: float,
    cells: Mapping[str, tuple[str, ...]],
    surfaces: Sequence[Named],
    with_material: Mapping[str, Mapping[str, str]],
    smooth: Sequence[str] = (),
) -> AnyMesh:
    """Read bodies, the nodes of each apart from those of the others.

    Parameters
    ----------
    path : str or None
        File of all bodies.
    paths : mapping of str to str
        Files by body instead, in the order of the bodies.
    dim : int
        Dimension of the bodies.
    length_unit : float
        Length of one unit of the files [m].
    cells : mapping of str to tuple of str
        Cell sets of each body.
    surfaces : sequence of Named
    with_material : mapping of str to mapping of str to str
        Cell sets that become parts of their own, by body, with the paths of their tables.
    smooth : sequence of str
        Surfaces that are curved, see `curved.curved`.

    Raises
    ------
    CaseError
        One line, reported at the key at fault.
    """
    contents = _contents(path, {body: paths[body] for body in cells if paths}, dim)
    contents = replace(contents, points=contents.points * length_unit)
    mesh = bodies_in(contents, cells, surfaces, with_material)
    return curved(mesh, smooth, "geometry.curved") if smooth else mesh


def has_surface(name: str, path: str | None, paths: Mapping[str, str], dim: int) -> bool:
    """Test whether files can be read and name a surface, see `read_bodies`."""
    try:
        contents = _contents(path, paths, dim)
    except CaseError:
        return False
    return contents.spelled(name) in (*contents.names(dim - 1), *contents.node_sets)


def bodies_in(
    contents: MeshContents,
    cells: Mapping[str, tuple[str, ...]],
    surfaces: Sequence[Named],
    with_material: Mapping[str, Mapping[str, str]],
) -> AnyMesh:
    """Mesh of bodies from contents in metres, see `read_bodies`."""

    def in_file(parts: Iterable[Named]) -> list[Named]:
        return [replace(of, sets=tuple(map(contents.spelled, of.sets))) for of in parts]

    bodies = [
        Named(body, sets, f"geometry.bodies.{body}", index)
        for index, (body, sets) in enumerate(cells.items())
    ]
    parts = [
        Named(f"{body}.{name}", (name,), key, index)
        for index, body in enumerate(cells)
        for name, key in with_material.get(body, {}).items()
    ]
    bodies, parts = in_file(bodies), in_file(parts)
    return divided(assemble(contents, bodies, in_file(surfaces)), contents, bodies, parts)


def _contents(path: str | None, paths: Mapping[str, str], dim: int) -> MeshContents:
    """Contents of the file, or of those of all bodies."""
    if path is not None:
        return read_contents(Path(path), dim)
    each = [read_contents(Path(of), dim, f"geometry.paths.{b}") for b, of in paths.items()]
    return joined(each)
