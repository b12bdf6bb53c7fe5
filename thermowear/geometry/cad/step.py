"""STEP export (CAD, in millimetres) of worn bodies: by OpenCASCADE, and as faceted solids.

Plane sides of a mesh are single faces; curved ones, and the worn face, consist of triangles between
the nodes. OpenCASCADE's own reconstruction of curved faces from triangles is not part of gmsh.

A plane body is its outline, with a B-spline through the worn face, extruded or revolved; a body in
space is a prism on a B-spline surface through its worn face.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy

from ...errors import CaseError
from ...lagrange import lattice
from ..mesh.gmsh_session import gmsh_model, write_step
from ..mesh.nodes import (
    boundary,
    chord_lengths,
    components,
    meeting,
    reference_nodes,
    shape_functions,
)
from ..mesh.tagged import TaggedMesh
from ..moving.outline import Piece, loops
from .design import Design
from .worn_body import face_motion, offsets, slide

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
            _loops(edges[border[own]]), key=lambda k: -_area_of_edges(points[edges[border[own[k]]]])
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


def _area_of_edges(edges: np.ndarray) -> float:
    """Twice the area of a plane polygon of edges (n, 2, 3)."""
    first, second = np.moveaxis(edges - edges[0, 0], 1, 0)
    return float(np.linalg.norm(np.cross(first, second).sum(axis=0)))


_STRAIGHT = 1e-9  # relative to the length of a piece
_ROUND = 1e-7  # relative to the radius
_POINT = 1e-9  # m; closer points coincide
_WITHIN = 5
"""Points of a surface along each side of a facet, both ends included."""


def write_section(
    mesh: TaggedMesh,
    design: Design,
    face: str,
    path: Path,
    thick: float = 0.0,
    turn: float | None = None,
    half: bool = False,
) -> None:
    """Write the solid of a plane body whose contact face has a worn shape.

    The worn face is a B-spline through the points of the design; other sides are straight lines,
    circular arcs, or B-splines through the nodes of the mesh.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of the unworn body.
    design : Design
    face : str
        Name of its contact face.
    path : Path
    thick : float
        Length of the extrusion of the section, symmetric to its plane [m].
    turn : float, optional
        Angle of revolution about the y-axis, instead of an extrusion [rad].
    half : bool
        True if the mesh covers the half x >= 0 of a symmetric body, which is written as a whole.

    Raises
    ------
    CaseError
        If the file cannot be written.
    """
    with gmsh_model("worn body") as gmsh:
        occ = gmsh.model.occ
        drawn = [_outline(mesh.points, pieces, design) for pieces in loops(mesh, face)]
        drawn.sort(key=_area, reverse=True)  # holes have the opposite orientation
        section = [(2, occ.addPlaneSurface([_wire(occ, curves) for curves in drawn]))]
        if turn is None:
            occ.translate(section, 0.0, 0.0, -thick * _UNIT / 2)
            solid = [e for e in occ.extrude(section, 0.0, 0.0, thick * _UNIT) if e[0] == 3]
            if half:
                other = occ.copy(solid)
                occ.mirror(other, 1.0, 0.0, 0.0, 0.0)
                occ.fuse(solid, other)
        else:
            occ.revolve(section, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, turn)
        occ.synchronize()
        write_step(gmsh, path)


@dataclass(frozen=True)
class _Curve:
    """Curve of an outline: points in order (n, 2) [m]; ``"line"``, ``"arc"`` or ``"spline"``."""

    points: np.ndarray
    kind: str

    def moved(self, end: int, place: np.ndarray) -> _Curve:
        """Copy of a line or circle with an end (0 or -1) moved to the closest point to a place."""
        points = self.points.copy()
        if self.kind == "arc":
            centre, radius = _circle(points)
            place = centre + radius * (place - centre) / np.linalg.norm(place - centre)
        points[end] = place
        return replace(self, points=points)


def _outline(points: np.ndarray, pieces: list[Piece], design: Design) -> list[_Curve]:
    """Curves of a loop including the worn face, each starting at the end of the one before."""
    curves = [_classified(points[piece.nodes]) for piece in pieces]
    for k, piece in enumerate(pieces):
        if not piece.is_face:
            continue
        before, after = k - 1, (k + 1) % len(pieces)
        sides = curves[before].points[:-3:-1], curves[after].points[:2]
        ends = [slide(design, *side) for side in sides]
        start, face = points[piece.nodes[0]], design.points
        if np.linalg.norm(face[-1] - start) < np.linalg.norm(face[0] - start):
            face = face[::-1]
        face = face + face_motion(design, face, ends)
        for end, side in ((0, before), (-1, after)):
            if ends[end] is not None:
                curves[side] = curves[side].moved(-1 - end, face[end])
                face[end] = curves[side].points[-1 - end]
        curves[k] = _Curve(face, "spline")
    closed = []
    for k, curve in enumerate(curves):
        step = np.array([curves[k - 1].points[-1], curve.points[0]])
        near = np.linalg.norm(step[1] - step[0]) < _POINT
        closed += [curve] if near else [_Curve(step, "line"), curve]
    return closed


def _classified(points: np.ndarray) -> _Curve:
    """Classify a piece of an outline as line, arc or spline by its nodes."""
    chord = points[-1] - points[0]
    length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    off = (points - points[0]) @ np.array([-chord[1], chord[0]])
    if np.linalg.norm(chord) > 0.0 and np.abs(off).max() < _STRAIGHT * length**2:
        return _Curve(points, "line")
    centre, radius = _circle(points)
    distance = np.linalg.norm(points - centre, axis=1)
    return _Curve(points, "arc" if np.ptp(distance) < _ROUND * radius else "spline")


def _circle(points: np.ndarray) -> tuple[np.ndarray, float]:
    """Least-squares circle through points: centre and radius [m]."""
    middle = points.mean(axis=0)
    size = np.ptp(points, axis=0).max()
    x = (points - middle) / size
    a, b, c = np.linalg.lstsq(np.column_stack([2 * x, np.ones(len(x))]), (x**2).sum(axis=1))[0]
    return middle + size * np.array([a, b]), size * math.sqrt(max(c + a**2 + b**2, 0.0))


def _wire(occ, curves: list[_Curve]) -> int:
    """Add a loop to the model."""
    starts = [_point(occ, curve.points[0]) for curve in curves]
    drawn = []
    for k, curve in enumerate(curves):
        start, end = starts[k], starts[(k + 1) % len(curves)]
        if curve.kind == "line":
            drawn.append(occ.addLine(start, end))
        elif curve.kind == "arc" and np.array_equal(*curve.points[[0, -1]]):
            centre, radius = _circle(curve.points)
            drawn.append(occ.addCircle(*(centre * _UNIT), 0.0, radius * _UNIT))
        elif curve.kind == "arc":
            middle = _point(occ, curve.points[len(curve.points) // 2])
            drawn.append(occ.addCircleArc(start, middle, end, center=False))
        else:
            drawn.append(_spline(occ, curve.points, start, end))
    return occ.addCurveLoop(drawn)


def _spline(occ, points: np.ndarray, start: int, end: int) -> int:
    """Cubic B-spline through points; OpenCASCADE's own is off by up to a micrometre."""
    control, knots, multiplicities = _interpolated(chord_lengths(points), points)
    inner = [_point(occ, place) for place in control[1:-1]]
    return occ.addBSpline(
        [start, *inner, end], degree=3, knots=knots, multiplicities=multiplicities
    )


def _interpolated(
    at: np.ndarray, points: np.ndarray, axis: int = 0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Control points, knots and their multiplicities of the cubic B-spline through points."""
    spline = scipy.interpolate.make_interp_spline(at, points, k=3, axis=axis)
    return np.moveaxis(spline.c, 0, axis), *np.unique(spline.t, return_counts=True)


def _point(occ, point: np.ndarray) -> int:
    return occ.addPoint(*(point * _UNIT), 0.0)


def _area(curves: list[_Curve]) -> float:
    """Signed area enclosed by a loop, positive anticlockwise, of its polygon [m²]."""
    x, y = np.concatenate([curve.points[:-1] for curve in curves]).T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


def write_prism(mesh: TaggedMesh, design: Design, face: str, path: Path) -> None:
    """Write the solid of a body whose contact face has a worn shape.

    The body stands on its face, z upwards, with vertical sides and a plane top. The surface
    interpolates a grid of points of the worn face.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of the unworn body.
    design : Design
    face : str
        Name of its contact face, a structured patch of quadrilateral facets.
    path : Path

    Raises
    ------
    CaseError
        If the file cannot be written.
    """
    grid = face_grid(mesh, face)
    flat = grid.reshape(-1, 3)
    worn = (flat + offsets(design, flat)).reshape(grid.shape)
    low, high = mesh.points.min(axis=0) * _UNIT, mesh.points.max(axis=0) * _UNIT
    size = high - low
    with gmsh_model("worn body") as gmsh:
        occ = gmsh.model.occ
        prism = occ.extrude([(2, _surface(occ, worn * _UNIT))], 0.0, 0.0, 2 * size[2])
        below = low - size
        box = occ.addBox(*below, *(3 * size[:2]), high[2] - below[2])
        occ.intersect([entity for entity in prism if entity[0] == 3], [(3, box)])
        occ.synchronize()
        write_step(gmsh, path)


def face_grid(mesh: TaggedMesh, face: str) -> np.ndarray:
    """Grid of points of a face of structured facets, shape (n_u, n_v, 3) [m]."""
    facets = mesh.facets_of(face)
    corners = _lattice(facets[:, :4])
    xi, eta = (step[:, None] for step in np.indices((_WITHIN, _WITHIN)).reshape(2, -1))
    points = shape_functions("quadrilateral", mesh.order, np.hstack([xi, eta]) / (_WITHIN - 1))
    grid = np.full((*(corners.max(axis=(0, 1)) * (_WITHIN - 1) + 1), 3), np.nan)
    for nodes, (a, b, _, d) in zip(facets, corners, strict=True):
        i, j = (a * (_WITHIN - 1) + xi * (b - a) + eta * (d - a)).T
        grid[i, j] = points @ mesh.points[nodes]
    return grid


def _lattice(facets: np.ndarray) -> np.ndarray:
    """Integer coordinates (i, j) of the corners of structured facets, shape (n, 4, 2) from 0.

    The patch is traversed from the first facet across common edges.
    """
    edges: dict[frozenset, list[tuple[int, int]]] = {}
    for f, corners in enumerate(facets.tolist()):
        for k in range(4):
            edges.setdefault(frozenset((corners[k], corners[k - 3])), []).append((f, k))
    found = np.full((*facets.shape, 2), np.iinfo(np.int64).min)
    found[0] = [[0, 0], [1, 0], [1, 1], [0, 1]]
    waiting, seen = [0], {0}
    while waiting:
        f = waiting.pop()
        for k in range(4):
            across = found[f, k] - found[f, k - 1]
            for g, m in edges[frozenset(facets[f, [k, k - 3]].tolist())]:
                if g in seen:
                    continue
                same = facets[g, m] == facets[f, k]
                shared = found[f, [k, k - 3]][:: 1 if same else -1]
                found[g, [m, m - 3]], found[g, [m - 1, m - 2]] = shared, shared + across
                seen.add(g)
                waiting.append(g)
    return found - found.min(axis=(0, 1))


def _surface(occ, grid: np.ndarray) -> int:
    """Bicubic B-spline through a grid of points, parametrised by their mean distances [mm]."""
    control, knots = grid, []
    for axis in (0, 1):
        steps = np.linalg.norm(np.diff(grid, axis=axis), axis=2).mean(axis=1 - axis)
        at = np.concatenate([[0.0], np.cumsum(steps)])
        control, *of_axis = _interpolated(at, control, axis)
        knots.append(of_axis)
    tags = [occ.addPoint(*point) for row in np.moveaxis(control, 0, 1) for point in row]
    return occ.addBSplineSurface(
        tags,
        len(control),
        degreeU=3,
        degreeV=3,
        knotsU=knots[0][0],
        knotsV=knots[1][0],
        multiplicitiesU=knots[0][1],
        multiplicitiesV=knots[1][1],
    )
