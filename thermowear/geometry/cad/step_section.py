"""STEP export of a worn plane body: outline with a B-spline through the worn face."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy

from ..mesh.gmsh_session import gmsh_model
from ..mesh.nodes import chord_lengths
from ..mesh.tagged import TaggedMesh
from ..moving.outline import Piece, loops
from .design import Design
from .step_prism import UNIT, save
from .worn_body import face_motion, slide

_STRAIGHT = 1e-9  # relative to the length of a piece
_ROUND = 1e-7  # relative to the radius
_POINT = 1e-9  # m; closer points coincide


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
            occ.translate(section, 0.0, 0.0, -thick * UNIT / 2)
            solid = [e for e in occ.extrude(section, 0.0, 0.0, thick * UNIT) if e[0] == 3]
            if half:
                other = occ.copy(solid)
                occ.mirror(other, 1.0, 0.0, 0.0, 0.0)
                occ.fuse(solid, other)
        else:
            occ.revolve(section, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, turn)
        occ.synchronize()
        save(gmsh, path)


@dataclass(frozen=True)
class _Curve:
    """Curve of an outline.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        Points in order [m].
    kind : str
        ``"line"``, ``"arc"`` or ``"spline"``.
    """

    points: np.ndarray
    kind: str

    @property
    def closed(self) -> bool:
        return bool(np.array_equal(self.points[0], self.points[-1]))

    def ended(self, end: np.ndarray) -> _Curve:
        """Copy of a line or circle with its last point moved to the closest point to `end`."""
        if self.kind == "arc":
            centre, radius = _circle(self.points)
            end = centre + radius * (end - centre) / np.linalg.norm(end - centre)
        return replace(self, points=np.vstack([self.points[:-1], end]))

    def backwards(self) -> _Curve:
        return replace(self, points=self.points[::-1])


def _outline(points: np.ndarray, pieces: list[Piece], design: Design) -> list[_Curve]:
    """Curves of a loop including the worn face, each starting at the end of the one before."""
    curves = [_classified(points[piece.nodes]) for piece in pieces]
    for k, piece in enumerate(pieces):
        if not piece.is_face:
            continue
        before, after = k - 1, (k + 1) % len(pieces)
        sides = [curves[before].backwards(), curves[after]]
        ends = [slide(design, *side.points[:2]) for side in sides]
        start, face = points[piece.nodes[0]], design.points
        if np.linalg.norm(face[-1] - start) < np.linalg.norm(face[0] - start):
            face = face[::-1]
        face = face + face_motion(design, face, ends)
        if ends[0] is not None:
            curves[before] = curves[before].ended(face[0])
            face[0] = curves[before].points[-1]
        if ends[1] is not None:
            curves[after] = curves[after].backwards().ended(face[-1]).backwards()
            face[-1] = curves[after].points[0]
        curves[k] = _Curve(face, "spline")
    return [
        joined
        for k, curve in enumerate(curves)
        for joined in _with_gap_closed(curves[k - 1], curve)
    ]


def _with_gap_closed(before: _Curve, curve: _Curve) -> list[_Curve]:
    """Curve, preceded by the segment from the end of the one before if there is a gap."""
    step = np.array([before.points[-1], curve.points[0]])
    near = np.linalg.norm(step[1] - step[0]) < _POINT
    return [curve] if near else [_Curve(step, "line"), curve]


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
        elif curve.kind == "arc" and curve.closed:
            centre, radius = _circle(curve.points)
            drawn.append(occ.addCircle(*(centre * UNIT), 0.0, radius * UNIT))
        elif curve.kind == "arc":
            middle = _point(occ, curve.points[len(curve.points) // 2])
            drawn.append(occ.addCircleArc(start, middle, end, center=False))
        else:
            drawn.append(_spline(occ, curve.points, start, end))
    return occ.addCurveLoop(drawn)


def _spline(occ, points: np.ndarray, start: int, end: int) -> int:
    """Cubic B-spline through points; OpenCASCADE's own is off by up to a micrometre."""
    spline = scipy.interpolate.make_interp_spline(chord_lengths(points), points, k=3)
    knots, multiplicities = np.unique(spline.t, return_counts=True)
    inner = [_point(occ, control) for control in spline.c[1:-1]]
    return occ.addBSpline(
        [start, *inner, end], degree=3, knots=knots, multiplicities=multiplicities
    )


def _point(occ, point: np.ndarray) -> int:
    return occ.addPoint(*(point * UNIT), 0.0)


def _area(curves: list[_Curve]) -> float:
    """Signed area enclosed by a loop, positive anticlockwise, of its polygon [m²]."""
    x, y = np.concatenate([curve.points[:-1] for curve in curves]).T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)
