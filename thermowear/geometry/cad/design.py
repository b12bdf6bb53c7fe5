"""Design: initial shape of a contact face for which there is no running-in.

Its table has one row per point of the unworn face. Files of other formats, which hold the body
with that face moved, carry the same table as a comment: a run can start from any of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import scipy

from ...errors import CaseError
from ...user_files import read_bytes
from ..mesh.nodes import chord_lengths

HEADERS = (
    "body",
    *("x_m", "y_m", "z_m", "s_m"),
    *("normal_x", "normal_y", "normal_z"),
    *("shape_m", "shape_along_press_m", "depth_m"),
)
"""Columns of the table; ``body`` is 1 or 2."""
_NOT_NEEDED = ("s_m", "shape_m", "shape_along_press_m")
_FEWEST = 4
_LARGEST = 100_000_000  # bytes of a file that carries a design
_COMMENTS = {
    ".msh": ("$Comments", "$EndComments"),
    ".vtu": ("<!--", "-->"),
    ".step": ("/*", "*/"),
}
"""First and last line of a comment by file ending."""
CARRIERS = tuple(_COMMENTS)
"""File endings of formats that carry the table as a comment."""
_NEAR = 1e-3  # relative to the face: larger distance to it means a different face
_STEPS = 20  # of the Gauss-Newton closest-point projection
_NEIGHBOURS = 40  # points of the interpolation stencil in space


@dataclass(frozen=True)
class Design:
    """Unloaded, unheated steady shape of one contact face; the other face stays unworn.

    Attributes
    ----------
    body : int
        1 or 2.
    points : ndarray, shape (n, gdim)
        Points of the unworn face, ordered along it in plane models [m].
    s : ndarray, shape (n,)
        Arc length along the face [m]; NaN in space.
    normals : ndarray, shape (n, gdim)
        Outward unit normals of the body.
    shape, shape_along_press : ndarray, shape (n,)
        Height above the deepest point, towards the other face, along the normal and along the load
        direction [m].
    depth : ndarray, shape (n,)
        Depth to be removed along the normal, nowhere negative [m].
    """

    body: int
    points: np.ndarray
    s: np.ndarray
    normals: np.ndarray
    shape: np.ndarray
    shape_along_press: np.ndarray
    depth: np.ndarray

    @property
    def extent(self) -> float:
        """Size of the face [m]."""
        return float(np.ptp(self.points, axis=0).max())

    def depth_at(self, points: np.ndarray) -> np.ndarray:
        """Depth at points (n, gdim) of the face, shape (n,) [m].

        Raises
        ------
        ValueError
            If the points do not lie on the face.
        """
        if self.points.shape[1] == 3:
            return self._in_space(points)
        return self._curve(self._along(points))

    def normals_at(self, points: np.ndarray) -> np.ndarray:
        """Outward unit normals at points (n, gdim) of the face, shape (n, gdim)."""
        if self.points.shape[1] == 3:
            return self.normals[scipy.spatial.cKDTree(self.points).query(points)[1]]
        s = self._along(points)
        normals = np.column_stack([np.interp(s, self._lengths, n) for n in self.normals.T])
        return normals / np.linalg.norm(normals, axis=1, keepdims=True)

    def _along(self, points: np.ndarray) -> np.ndarray:
        """Chord lengths at the closest points of a curve through the design points [m]."""
        face, slopes = self._face, self._face.derivative()
        s = self._lengths[scipy.spatial.cKDTree(self.points).query(points)[1]]
        for _ in range(_STEPS):
            offset, tangent = face(s) - points, slopes(s)
            s = s - (offset * tangent).sum(axis=1) / (tangent**2).sum(axis=1)
            s = np.clip(s, 0.0, self._lengths[-1])
        off = np.linalg.norm(face(s) - points, axis=1).max()
        if off > _NEAR * self.extent:
            raise ValueError(f"belongs to a face up to {off:.3g} m away from the contact face")
        return s

    @cached_property
    def _lengths(self) -> np.ndarray:
        """Chord lengths along the points, shape (n,) [m]."""
        return chord_lengths(self.points)

    @cached_property
    def _face(self) -> scipy.interpolate.CubicSpline:
        return scipy.interpolate.CubicSpline(self._lengths, self.points)

    @cached_property
    def _curve(self) -> scipy.interpolate.CubicSpline:
        return scipy.interpolate.CubicSpline(self._lengths, self.depth)

    def _in_space(self, points: np.ndarray) -> np.ndarray:
        """Interpolation in the plane normal to the mean normal."""
        distance = scipy.spatial.cKDTree(self.points).query(points)[0].max()
        if distance > 0.5 * self.extent:
            raise ValueError(f"belongs to a face up to {distance:.3g} m away from the contact face")
        across = np.linalg.svd(self.normals.mean(axis=0)[None])[2][1:]
        known = self.points @ across.T / self.extent
        neighbours = min(_NEIGHBOURS, len(known))
        curve = scipy.interpolate.RBFInterpolator(
            known, self.depth, neighbors=neighbours, kernel="cubic"
        )
        return curve(points @ across.T / self.extent)


def write_table(design: Design, path: Path) -> None:
    """Write a design as a table with one row per point.

    Raises
    ------
    CaseError
        If the file cannot be written.
    """
    try:
        path.write_text(_text(design), encoding="utf-8")
    except OSError as error:
        raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None


def add_table(design: Design, path: Path) -> None:
    """Add the table of a design to its file in another format, as a comment.

    Nodes of a mesh and control points of a surface are too coarse to start a run from.

    Raises
    ------
    CaseError
        If the file cannot be written.
    """
    first, last = _COMMENTS[path.suffix]
    comment = f"{first}\n{_text(design)}{last}\n"
    try:
        head, rest = path.read_text("utf-8"), ""
        if path.suffix == ".step":  # readers stop at the last line
            start = head.index("\n") + 1
            head, rest = head[:start], head[start:]
        path.write_text(head + comment + rest, "utf-8")
    except OSError as error:
        raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None


def read_table(path: Path) -> np.ndarray | None:
    """Table of a design from a file of any format, columns by name; None if there is none.

    Raises
    ------
    OSError, ValueError
        If the file cannot be read.
    """
    lines = read_bytes(path, _LARGEST).decode("utf-8-sig", errors="replace").splitlines()
    heads = [k for k, line in enumerate(lines) if "depth_m" in line.split(",")]
    if not heads:
        return None
    ends = tuple(last for _, last in _COMMENTS.values())
    rows = lines[heads[0] :]
    end = next((k for k, line in enumerate(rows) if line.startswith(ends)), len(rows))
    return np.atleast_1d(np.genfromtxt(rows[:end], delimiter=",", names=True))


def from_table(table: np.ndarray, gdim: int) -> Design:
    """Design from the columns of its table.

    Parameters
    ----------
    table : ndarray with names
        Columns as in `HEADERS`; arc lengths and shapes are optional.
    gdim : int
        2 or 3.

    Raises
    ------
    ValueError
        If a column is missing, has entries that are not numbers, or depths beyond the face's size.
    """
    columns = table.dtype.names or ()
    needed = [name for name in HEADERS if name not in _NOT_NEEDED]
    missing = [name for name in needed if name not in columns]
    if missing:
        raise ValueError(f"has no column {missing[0]}")
    if len(table) < _FEWEST or not all(np.isfinite(table[name]).all() for name in needed):
        raise ValueError(f"has entries that are not numbers, or fewer than {_FEWEST} rows")
    bodies = np.unique(table["body"])
    if len(bodies) != 1 or bodies[0] not in (1, 2):
        raise ValueError("must have either 1 or 2 in all rows of the column body")
    places = np.array([table[f"{axis}_m"] for axis in "xyz"[:gdim]])
    deepest, extent = np.abs(table["depth_m"]).max(), np.ptp(places, axis=1).max()
    if not deepest < extent:
        raise ValueError(
            f"has depths up to {deepest:.3g} m on a face of {extent:.3g} m; are they in metres?"
        )
    nothing = np.full(len(table), np.nan)
    s, shape, along = (table[h] if h in columns else nothing for h in _NOT_NEEDED)
    return Design(
        body=int(bodies[0]),
        points=places.T,
        s=s,
        normals=np.column_stack([table[f"normal_{axis}"] for axis in "xyz"[:gdim]]),
        shape=shape,
        shape_along_press=along,
        depth=table["depth_m"],
    )


def _text(design: Design) -> str:
    count, gdim = design.points.shape
    points, normals = (
        np.pad(of, ((0, 0), (0, 3 - gdim))) for of in (design.points, design.normals)
    )
    shapes = design.shape, design.shape_along_press, design.depth
    table = np.column_stack([np.full(count, design.body), points, design.s, normals, *shapes])
    rows = [",".join(f"{value:.15g}" for value in row) for row in table]
    return "\n".join([",".join(HEADERS), *rows, ""])
