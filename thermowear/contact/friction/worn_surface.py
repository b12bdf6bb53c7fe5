"""Worn profile of a face in space, which slides along the face that carries the points.

A Delaunay triangulation is not unique where places lie on a circle, as those of each rectangle of a
grid do: triangles of one circle form one cell here, with the rational functions of its corners that
are linear along its edges (Wachspress, A Rational Finite Element Basis, 1975). Flat triangles at
the outline, which hide a place behind those next to it, are no cells.

The profile is interpolated between the places of its coefficients, in the plane across the mean
normal of the face, see `PlaneCells`. Beyond its outline it is continued by the nearest values.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay

from ...errors import CaseError
from ..operators.rigid_motion import middle_in_space
from ..search.pairing import Pairing

_FLATTEST_CORNER = np.cos(np.radians(150.0))
"""Cosine of the widest angle of a triangle opposite to an edge of the outline."""
_ON_CIRCLE = 1e-9
"""Largest distance of places from the circle of a cell, relative to its radius."""
_ON_EDGE = 1e-60
"""Area between a point and an edge that it lies on, relative to that of a corner."""
_BLOCK = 2_000_000
"""Pairs of a point and an edge of the outline that are compared at once."""


@dataclass(frozen=True)
class PlaneCells:
    """Cells between places.

    Attributes
    ----------
    places : ndarray, shape (m, 2) [m]
    """

    places: np.ndarray

    def hats(self, points: np.ndarray) -> np.ndarray:
        """Values at points (n, 2) of the functions of all places, shape (n, m).

        Each is 1 at its place and 0 at others. Beyond the outline the nearest values on it hold.
        """
        result = np.zeros((len(points), len(self.places)))
        triangle = self._triangles.find_simplex(points)
        cell = np.where(triangle < 0, -1, self._cell[triangle])
        for numbers, corners in self._polygons:
            inside = np.flatnonzero(np.isin(cell, numbers))
            of = corners[np.searchsorted(numbers, cell[inside])]
            result[inside[:, None], of] = _rational(self.places[of], points[inside])
        outside = np.flatnonzero(cell < 0)
        step = max(1, _BLOCK // len(self._outline))
        for start in range(0, len(outside), step):
            chosen = outside[start : start + step]
            ends, part = self._nearest(points[chosen])
            result[chosen, ends[:, 0]] += 1 - part
            result[chosen, ends[:, 1]] += part
        return result

    @cached_property
    def _triangles(self) -> Delaunay:
        return Delaunay(self.places)

    @cached_property
    def _beside(self) -> np.ndarray:
        """Triangle beyond the edge opposite to each corner, -1 at the outline, (n_triangles, 3)."""
        beside = self._triangles.neighbors.copy()
        flat = _cosines(self.places[self._triangles.simplices]) < _FLATTEST_CORNER
        gone = np.zeros(len(beside), dtype=bool)
        while np.any(outer := ~gone & np.any(flat & (beside < 0), axis=1)):
            gone |= outer
            beside[gone[beside] & (beside >= 0)] = -1
        beside[gone] = -2
        return beside

    @cached_property
    def _cell(self) -> np.ndarray:
        """Cell of each triangle, -1 outside of the outline, shape (n_triangles,)."""
        corners, beside = self.places[self._triangles.simplices], self._beside
        centre, radius = _circles(corners)
        one, edge = np.nonzero(beside >= 0)
        next_one = beside[one, edge]
        distance = np.linalg.norm(corners[next_one] - centre[one, None], axis=2)
        same = np.abs(distance - radius[one, None]).max(axis=1) <= _ON_CIRCLE * radius[one]
        links = coo_array((same[same], (one[same], next_one[same])), (len(beside),) * 2)
        cell = connected_components(links, directed=False)[1]
        return np.where(beside[:, 0] < -1, -1, cell)

    @cached_property
    def _polygons(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Cells of each number of corners k, and corners in order around them, (n_cells, k)."""
        inside = np.flatnonzero(self._cell >= 0)
        corners = self._triangles.simplices[inside]
        pairs = np.column_stack([np.repeat(self._cell[inside], 3), corners.ravel()])
        cell, corner = np.unique(pairs, axis=0).T
        numbers, of, count = np.unique(cell, return_inverse=True, return_counts=True)
        middle = np.column_stack([np.bincount(of, x[corner]) / count for x in self.places.T])
        y, x = (self.places[corner] - middle[of]).T[::-1]
        corner = corner[np.lexsort([np.arctan2(y, x), cell])]
        sizes = np.repeat(count, count)
        return [(numbers[count == k], corner[sizes == k].reshape(-1, k)) for k in np.unique(count)]

    @cached_property
    def _outline(self) -> np.ndarray:
        """Ends of the edges of the outline, shape (n_edges, 2)."""
        triangle, edge = np.nonzero(self._beside == -1)
        ends = (edge[:, None] + (1, 2)) % 3
        return np.take_along_axis(self._triangles.simplices[triangle], ends, axis=1)

    def _nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nearest edge of the outline to points (n, 2): its ends (n, 2), and the part along it."""
        start, end = np.moveaxis(self.places[self._outline], 1, 0)
        along = end - start
        part = ((points[:, None] - start) * along).sum(axis=2) / (along**2).sum(axis=1)
        part = np.clip(part, 0.0, 1.0)
        off = points[:, None] - start - part[..., None] * along
        nearest = (off**2).sum(axis=2).argmin(axis=1)
        return self._outline[nearest], part[np.arange(len(points)), nearest]


def _rational(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Functions of the corners (n, k, 2) of convex polygons at points (n, 2) in them, (n, k)."""
    before, after = np.roll(corners, 1, axis=1), np.roll(corners, -1, axis=1)
    whole = _area(before, corners, after)
    scale = whole.max(axis=1, keepdims=True)
    to_next = np.maximum(_area(points[:, None], corners, after) / scale, _ON_EDGE)
    values = whole / scale / to_next / np.roll(to_next, 1, axis=1)
    return values / values.sum(axis=1, keepdims=True)


def _area(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Twice the signed area of triangles."""
    (x, y), (u, v) = np.moveaxis(b - a, -1, 0), np.moveaxis(c - a, -1, 0)
    return x * v - y * u


def _cosines(corners: np.ndarray) -> np.ndarray:
    """Cosines of the angles of triangles (n, 3, 2), shape (n, 3)."""
    to_next = np.roll(corners, -1, axis=1) - corners
    to_next /= np.linalg.norm(to_next, axis=2, keepdims=True)
    return -np.einsum("nki,nki->nk", to_next, np.roll(to_next, 1, axis=1))


def _circles(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centres (n, 2) and radii (n,) of the circles through triangles (n, 3, 2), inf if flat."""
    first = corners[:, 0]
    b, c = (corners[:, k] - first for k in (1, 2))
    twice = 2 * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        square_b, square_c = (b**2).sum(axis=1), (c**2).sum(axis=1)
        x = (c[:, 1] * square_b - b[:, 1] * square_c) / twice
        y = (b[:, 0] * square_c - c[:, 0] * square_b) / twice
    centre = np.column_stack([x, y])
    return first + centre, np.linalg.norm(centre, axis=1)


_FLATTEST = 0.1
"""Least cosine between the normals of a face and their mean."""


@dataclass(frozen=True)
class WornSurface:
    """Worn profile of a body in space: places of its coefficients on the face.

    Attributes
    ----------
    places : ndarray, shape (m, 2)
        Positions of the basis functions along the axes in the middle of the face [m].
    areas : ndarray, shape (m,)
        Areas of the basis functions [m²].
    shift_per_slip : float
        Displacement along the common face per unit slip.
    """

    places: np.ndarray
    areas: np.ndarray
    shift_per_slip: float

    def interpolation(self, slip: np.ndarray) -> np.ndarray:
        """Matrix L: coefficients at the contact from those of the profile, shape (m, m).

        Parameters
        ----------
        slip : ndarray, shape (3,)
            Slip of the first body along both axes [m], and its rotation about the normal [rad].
        """
        x, y = self.places.T
        moved = slip[:2] + slip[2] * np.column_stack([y, -x])
        shift = self.shift_per_slip * moved
        if not shift.any():
            return np.eye(len(self.places))
        return self._cells.hats(self.places - shift)

    def wear_transfer(self, slip: np.ndarray) -> np.ndarray:
        """Coefficients of the profile from the depths worn at the contact, shape (m, m)."""
        return self.interpolation(slip).T * self.areas / self.areas[:, None]

    @cached_property
    def _cells(self) -> PlaneCells:
        return PlaneCells(self.places)


def worn_surface(pairing: Pairing, weighted, shift_per_slip: float) -> WornSurface:
    """Worn profile at an interface in space.

    Parameters
    ----------
    pairing : Pairing
    weighted : csr_array, shape (n, m)
        ``diag(w) Ψ`` of the interface.
    shift_per_slip : float

    Raises
    ------
    CaseError
        If the face cannot be laid out on a plane.
    """
    middle, frame = middle_in_space(pairing)
    if (pairing.outward @ frame.pole).min() < _FLATTEST:
        raise CaseError(
            f"geometry: the contact face {pairing.carrying.face.name} turns by more than 84° from "
            "its mean normal; fretting wear in space needs faces that turn less"
        )
    areas = np.asarray(weighted.sum(axis=0)).ravel()
    positions = (pairing.points - middle) @ frame.axes.T
    places = np.asarray(weighted.T @ positions) / areas[:, None]
    return WornSurface(places, areas, shift_per_slip)
