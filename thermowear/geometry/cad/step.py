"""STEP export (CAD, in millimetres) of worn bodies by OpenCASCADE through gmsh.

A plane body is its outline, with a B-spline through the worn face, extruded or revolved; a body in
space is a prism on a B-spline surface through its worn face.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy

from ..mesh.gmsh_session import gmsh_model, write_step
from ..mesh.nodes import chord_lengths, shape_functions
from ..mesh.tagged import TaggedMesh
from ..moving.outline import Piece, loops
from .design import Design
from .worn_body import face_motion, offsets, slide

_UNIT = 1e3
"""Millimetres in a metre."""
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
