"""Remeshing of a body of tetrahedra inside its worn surface.

All facets of the surface and of borders between parts are kept with their nodes, and with them the
contact faces and the names of surfaces; only the interior is meshed anew, by gmsh in a process of
its own. Cells have the order of the former ones: nodes of curved facets keep their places, those
inside of the body follow harmonically.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...errors import ComputationError
from ..mesh.nodes import boundary, components, facet_nodes, reference_nodes, shape_functions
from ..mesh.tagged import TaggedMesh, scaled_jacobians
from .moved import Extension
from .remeshed import with_body

_MESHER = Path(__file__).with_name("solid_mesher.py")
_SECONDS = 300
"""Largest elapsed time of a run of gmsh."""
_SETTINGS = ((1, 0.3), (1, 0.6), (10, 0.3), (10, 0.6))
"""Algorithms of gmsh, and qualities below which it optimises cells; the best result varies."""
_GOOD = 0.25
"""Smallest scaled Jacobian above which no better mesh is sought."""
_SAME_VOLUME = 1e-6
"""Largest relative difference of the volume of new cells and of that inside of the surface."""
_LONGEST = 200
"""Largest number of characters of a message of gmsh."""


class _Shells(NamedTuple):
    """Closed surfaces of straight triangles that bound the parts of a body.

    Attributes
    ----------
    facets : ndarray of int, shape (n, nodes_per_facet)
        Boundary facets of all parts, outward.
    shell : ndarray of int, shape (n,)
        Closed surface of each facet.
    volume : ndarray of int, shape (n_shells,)
        Connected volume that each shell bounds.
    tags : ndarray of int, shape (n_volumes,)
        Tag of the part that each volume belongs to.
    """

    facets: np.ndarray
    shell: np.ndarray
    volume: np.ndarray
    tags: np.ndarray


def meshed_inside(mesh: TaggedMesh, parts: tuple[str, ...], extension: Extension) -> TaggedMesh:
    """Remesh the interior of a body of tetrahedra; its present cells may be inverted.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of all bodies of one cell type and order.
    parts : tuple of str
        Names of the body's parts.
    extension : callable
        Factory of harmonic extensions, for the interior nodes of curved cells.

    Raises
    ------
    ComputationError
        If gmsh cannot mesh the body.
    """
    shells = _shells(mesh, parts)
    best, highest, trouble = None, -np.inf, ""
    for settings in _SETTINGS:
        try:
            straight = _filled(mesh, shells, settings)
        except ValueError as reason:
            trouble = trouble or str(reason)
            continue
        body = _curved(mesh, shells, straight, extension)
        least = float(scaled_jacobians(body).min())
        if best is None or least > highest:
            best, highest = body, least
        if highest >= _GOOD:
            break
    if best is None:
        raise ComputationError(f"remeshing: gmsh could not mesh the worn body: {trouble}")
    return with_body(mesh, parts, best)


def _shells(mesh: TaggedMesh, parts: tuple[str, ...]) -> _Shells:
    """Closed surfaces of the connected volumes of the parts of a body."""
    count, bounds, tags = 0, [], list[int]()
    for tag in (tag for tag in mesh.tags_of(parts) if np.any(mesh.cell_tags == tag)):
        cells = mesh.cells[mesh.cell_tags == tag]
        connected = components(_through_facets(mesh, cells), len(cells))
        for number in range(connected.max() + 1):
            facets = boundary(mesh.cell_type, mesh.order, cells[connected == number])
            shell = _by_size(mesh.points, facets)
            volume = np.full(shell.max() + 1, len(tags))
            bounds.append((facets, count + shell, volume))
            tags.append(tag)
            count += len(volume)
    facets, shell, volume = (np.concatenate(each) for each in zip(*bounds, strict=True))
    return _Shells(facets, shell, volume, np.array(tags, dtype=np.int32))


def _by_size(points: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """Number of the connected closed surface of each facet, the largest first."""
    nodes, local = np.unique(facets[:, :3], return_inverse=True)
    local = local.reshape(-1, 3)
    piece = components(local[:, [0, 1, 1, 2]].reshape(-1, 2), len(nodes))[local[:, 0]]
    size = [np.ptp(points[facets[piece == k]], axis=(0, 1)).max() for k in range(piece.max() + 1)]
    return np.argsort(np.argsort(-np.array(size), kind="stable"), kind="stable")[piece]


def _through_facets(mesh: TaggedMesh, cells: np.ndarray) -> np.ndarray:
    """Pairs of cells with a common facet, shape (n, 2)."""
    local = facet_nodes(mesh.cell_type, mesh.order)[:, :3]
    corners = np.sort(cells[:, local].reshape(-1, 3), axis=1)
    order = np.lexsort(corners.T)
    same = np.all(corners[order[1:]] == corners[order[:-1]], axis=1)
    return np.column_stack([order[1:][same], order[:-1][same]]) // len(local)


def _filled(mesh: TaggedMesh, shells: _Shells, settings: tuple[int, float]) -> TaggedMesh:
    """Straight cells inside of the shells, their corners on the surface first.

    Raises
    ------
    ValueError
        If gmsh fails, or has not kept the surface.
    """
    corners, triangles = np.unique(shells.facets[:, :3], return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    points = mesh.points[corners]
    middle, size = points.mean(axis=0), float(np.ptp(points, axis=0).max())
    given = (points - middle) / size
    arrays = _run(
        points=given,
        triangles=triangles,
        shell=shells.shell,
        volume=shells.volume,
        settings=np.array(settings),
    )
    cells, places = arrays["cells"], arrays["points"]
    edges = np.moveaxis(places[cells[:, 1:]] - places[cells[:, :1]], 1, 0)
    volumes = np.einsum("ni,ni->n", np.cross(edges[0], edges[1]), edges[2]) / 6
    cells[volumes < 0] = cells[volumes < 0][:, [0, 2, 1, 3]]
    enclosed = np.einsum("ni,ni->", given[triangles[:, 0]], _crossed(given, triangles)) / 6
    if not np.array_equal(places[: len(given)], given):
        raise ValueError("it has moved nodes of the surface")
    if abs(np.abs(volumes).sum() - enclosed) > _SAME_VOLUME * enclosed:
        raise ValueError("it has not filled the surface")
    if not _same_surface(boundary("tetrahedron", 1, cells), triangles, len(shells.tags) > 1):
        raise ValueError("it has changed the triangles of the surface")
    return replace(
        mesh,
        points=np.concatenate([points, middle + size * places[len(given) :]]),
        cells=cells,
        cell_tags=shells.tags[arrays["volume"]],
        facets=np.empty((0, 3), dtype=np.int64),
        facet_tags=np.empty(0, dtype=np.int32),
    )


def _crossed(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Twice the area vectors of triangles."""
    first, second, third = np.moveaxis(points[triangles], 1, 0)
    return np.cross(second - first, third - first)


def _same_surface(found: np.ndarray, given: np.ndarray, several: bool) -> bool:
    """True if a boundary consists of given triangles; between several volumes are some more."""
    one, other = ({tuple(row) for row in np.sort(each, axis=1).tolist()} for each in (found, given))
    return one <= other if several else one == other


def _run(**given: np.ndarray) -> dict[str, np.ndarray]:
    """Arrays that the program computes from given ones, see `solid_mesher`."""
    packed = io.BytesIO()
    np.savez(packed, allow_pickle=False, **given)
    try:
        done = subprocess.run(
            [sys.executable, "-P", str(_MESHER)],
            input=packed.getvalue(),
            capture_output=True,
            timeout=_SECONDS,
            env=os.environ | {"OMP_NUM_THREADS": "1"},
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise ValueError(f"it took more than {_SECONDS} s") from None
    if done.returncode:
        reason = done.stderr.decode("utf-8", "replace").rpartition("\n")[2]
        raise ValueError(reason[:_LONGEST] if done.returncode == 1 else "it crashed")
    with np.load(io.BytesIO(done.stdout), allow_pickle=False) as file:
        return dict(file)


def _curved(
    mesh: TaggedMesh, shells: _Shells, straight: TaggedMesh, extension: Extension
) -> TaggedMesh:
    """Cells of the order of the mesh with the nodes of its facets."""
    kind, order = mesh.cell_type, mesh.order
    values = shape_functions(kind, 1, reference_nodes(kind, order))
    places = np.einsum("qk,cki->cqi", values, straight.points[straight.cells])
    _, triangles = np.unique(shells.facets[:, :3], return_inverse=True)
    keys = [_keys(kind, order, straight.cells)]
    keys += [_keys("triangle", order, triangles.reshape(-1, 3))]
    _, first, node = np.unique(np.concatenate(keys), axis=0, return_index=True, return_inverse=True)
    cells, on_facets = np.split(node.ravel(), [len(keys[0])])
    number = np.full(len(mesh.points), -1)
    number[shells.facets.ravel()] = on_facets
    kept = np.unique(shells.facets)
    at, named = number[kept], np.all(number[mesh.facets] >= 0, axis=1)
    body = replace(
        straight,
        points=places.reshape(-1, 3)[first],
        cells=cells.reshape(places.shape[:2]),
        facets=number[mesh.facets[named]],
        facet_tags=mesh.facet_tags[named],
    )
    points, known = body.points.copy(), np.zeros(len(body.points), dtype=bool)
    given, known[at] = np.zeros_like(points), True
    given[at] = mesh.points[kept] - points[at]
    if order > 1:
        points += extension(body, kind, body.cells, known)(given)
    points[at] = mesh.points[kept]
    return replace(body, points=points)


def _keys(kind: str, order: int, cells: np.ndarray) -> np.ndarray:
    """Rows that identify the nodes of cells with given corners: weights of corners, sorted."""
    weights = np.rint(order * shape_functions(kind, 1, reference_nodes(kind, order))).astype(int)
    codes = np.where(weights > 0, cells[:, None] * (order + 1) + weights, -1)
    codes = np.pad(codes, ((0, 0), (0, 0), (0, 4 - codes.shape[2])), constant_values=-1)
    return np.sort(codes, axis=2).reshape(-1, 4)
