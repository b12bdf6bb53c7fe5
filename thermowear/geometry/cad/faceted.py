"""STEP export of bodies in space of any shape, as solids bounded by plane faces.

Plane sides of a mesh are single faces; curved ones, and the worn face, consist of triangles between
the nodes. OpenCASCADE's own reconstruction of curved faces from triangles is not part of gmsh.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...errors import CaseError
from ...lagrange import lattice
from ..mesh.gmsh_session import gmsh_model, write_step
from ..mesh.nodes import boundary, components, meeting, reference_nodes
from ..mesh.tagged import TaggedMesh

_UNIT = 1e3
"""Millimetres in a metre."""
_SMOOTH = np.cos(np.radians(1.0))
"""Cosine of the largest angle between adjacent triangles of a plane face."""
_PLANE = 1e-7
"""Largest distance of points from a plane face, relative to the body."""
MOST_TRIANGLES = 20_000
"""Largest number of triangles: each is a face of the solid."""


def write_faceted(mesh: TaggedMesh, face: str, path: Path) -> None:
    """Write the solid inside of the boundary of the mesh of a body in space.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of one body of tetrahedra, with its worn face.
    face : str
        Name of its contact face, all of whose triangles are kept.
    path : Path

    Raises
    ------
    CaseError
        If there are too many triangles, or the file cannot be written.
    """
    facets = boundary(mesh.cell_type, mesh.order, mesh.cells)
    parts = _triangles(mesh.order)
    triangles = facets[:, parts].reshape(-1, 3)
    own = {tuple(corners) for corners in np.sort(mesh.facets_of(face)[:, :3]).tolist()}
    is_face = np.array([tuple(corners) in own for corners in np.sort(facets[:, :3]).tolist()])
    groups = _plane_groups(mesh.points, triangles, np.repeat(is_face, len(parts)))
    if groups.max() + 1 > MOST_TRIANGLES:
        raise CaseError(
            f"-o {path}: the solid has {groups.max() + 1} faces, more than {MOST_TRIANGLES}; "
            "use -o FILE.msh or -o FILE.vtu"
        )
    with gmsh_model("worn body") as gmsh:
        occ = gmsh.model.occ
        _draw(occ, mesh.points * _UNIT, triangles, groups)
        occ.synchronize()
        write_step(gmsh, path)


def _triangles(order: int) -> np.ndarray:
    """Nodes of the straight triangles into which a facet of an order is divided, (order², 3)."""
    steps = np.rint(order * reference_nodes("triangle", order)).astype(int)
    at = {tuple(step): k for k, step in enumerate(steps.tolist())}
    found = []
    for i, j in np.rint(order * lattice(order, "triangle")).astype(int).tolist():
        if i + j < order:
            found.append([at[i, j], at[i + 1, j], at[i, j + 1]])
        if i + j < order - 1:
            found.append([at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]])
    return np.array(found)


def _plane_groups(points: np.ndarray, triangles: np.ndarray, alone: np.ndarray) -> np.ndarray:
    """Number of the plane face that each triangle belongs to, shape (n,).

    Parameters
    ----------
    points : ndarray, shape (n_points, 3) [m]
    triangles : ndarray of int, shape (n, 3)
    alone : ndarray of bool, shape (n,)
        Triangles that are faces of their own.
    """
    first, second, third = np.moveaxis(points[triangles], 1, 0)
    normals = np.cross(second - first, third - first)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    pairs = meeting(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)) // 3
    smooth = np.einsum("ei,ei->e", *np.moveaxis(normals[pairs], 1, 0)) > _SMOOTH
    links = pairs[smooth & ~alone[pairs].any(axis=1)]
    groups = components(links, len(triangles))
    size = np.ptp(points[triangles], axis=(0, 1)).max()
    order = np.argsort(groups, kind="stable")
    for own in np.split(order, np.cumsum(np.bincount(groups))[:-1]):
        places = points[triangles[own]].reshape(-1, 3)
        flat = np.linalg.svd(places - places.mean(axis=0), full_matrices=False)
        if np.abs((places - places.mean(axis=0)) @ flat[2][-1]).max() > _PLANE * size:
            groups[own] = groups.max() + 1 + np.arange(len(own))
    return np.unique(groups, return_inverse=True)[1]


def _draw(occ, points: np.ndarray, triangles: np.ndarray, groups: np.ndarray) -> None:
    """Draw a solid of plane faces, each a group of triangles [mm]."""
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    keys = np.column_stack([np.repeat(groups, 3), np.sort(edges, axis=1)])
    _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
    border = first[count == 1]  # edges inside of a plane face occur twice in it
    ends, line = np.unique(np.sort(edges[border], axis=1), axis=0, return_inverse=True)
    tags = {int(node): occ.addPoint(*points[node]) for node in np.unique(ends)}
    lines = [occ.addLine(tags[a], tags[b]) for a, b in ends.tolist()]
    surfaces = []
    by_group = np.split(np.arange(len(border)), np.cumsum(np.bincount(groups[border // 3]))[:-1])
    for own in by_group:
        loops = sorted(
            _loops(edges[border[own]]), key=lambda k: -_area(points[edges[border[own[k]]]])
        )
        wires = [occ.addCurveLoop([lines[line[own[k]]] for k in loop]) for loop in loops]
        surfaces.append(occ.addPlaneSurface(wires))
    shells = components(_neighbours(triangles, groups), groups.max() + 1)
    bounds = [
        (float(np.ptp(points[triangles[shells[groups] == k]], axis=(0, 1)).max()), k)
        for k in range(shells.max() + 1)
    ]
    occ.addVolume(
        [
            occ.addSurfaceLoop([surfaces[g] for g in np.flatnonzero(shells == k)])
            for _, k in sorted(bounds, reverse=True)
        ]
    )


def _neighbours(triangles: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """Pairs of plane faces with a common edge, shape (n, 2)."""
    pairs = meeting(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)) // 3
    return groups[pairs]


def _loops(edges: np.ndarray) -> list[list[int]]:
    """Closed chains of directed edges (n, 2), as lists of their indices."""
    following: dict[int, list[int]] = {}
    for k, end in enumerate(edges[:, 0]):
        following.setdefault(int(end), []).append(k)
    found = []
    while following:
        start: int = next(iter(following))
        node, loop = start, list[int]()
        while not loop or node != start:
            left = following[node]
            loop.append(left.pop())
            if not left:
                del following[node]
            node = int(edges[loop[-1], 1])
        found.append(loop)
    return found


def _area(edges: np.ndarray) -> float:
    """Twice the area of a plane polygon of edges (n, 2, 3)."""
    first, second = np.moveaxis(edges - edges[0, 0], 1, 0)
    return float(np.linalg.norm(np.cross(first, second).sum(axis=0)))
