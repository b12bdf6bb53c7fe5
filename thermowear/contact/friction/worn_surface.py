"""Worn profile of a face in space, which slides along the face of the other body.

The profile is piecewise linear on the triangulation of the places of its coefficients, in the plane
across the mean normal of the face. Beyond its outline it is continued by the nearest values.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import Delaunay

from ...errors import CaseError
from ..operators.tangential import middle_in_space
from ..search.pairing import Pairing

_FLATTEST = 0.1
"""Least cosine between the normals of a face and their mean."""
_BLOCK = 2_000_000
"""Pairs of a point and an edge of the outline that are compared at once."""


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
        return self.hats(self.places - shift)

    def wear_transfer(self, slip: np.ndarray) -> np.ndarray:
        """Coefficients of the profile from the depths worn at the contact, shape (m, m)."""
        return self.interpolation(slip).T * self.areas / self.areas[:, None]

    def hats(self, points: np.ndarray) -> np.ndarray:
        """Values of the hat functions of all places at points (n, 2), shape (n, m)."""
        result = np.zeros((len(points), len(self.places)))
        triangle = self._triangles.find_simplex(points)
        inside = np.flatnonzero(triangle >= 0)
        corners = self._triangles.simplices[triangle[inside]]
        affine = self._triangles.transform[triangle[inside]]
        first = np.einsum("nij,nj->ni", affine[:, :2], points[inside] - affine[:, 2])
        weights = np.maximum(np.column_stack([first, 1 - first.sum(axis=1)]), 0.0)
        result[inside[:, None], corners] = weights / weights.sum(axis=1, keepdims=True)
        outside = np.flatnonzero(triangle < 0)
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
    def _outline(self) -> np.ndarray:
        """Ends of the edges of the outline, shape (n_edges, 2)."""
        return self._triangles.convex_hull

    def _nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nearest edge of the outline to points (n, 2): its ends (n, 2), and the part along it."""
        start, end = np.moveaxis(self.places[self._outline], 1, 0)
        along = end - start
        part = ((points[:, None] - start) * along).sum(axis=2) / (along**2).sum(axis=1)
        part = np.clip(part, 0.0, 1.0)
        off = points[:, None] - start - part[..., None] * along
        nearest = (off**2).sum(axis=2).argmin(axis=1)
        return self._outline[nearest], part[np.arange(len(points)), nearest]


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
