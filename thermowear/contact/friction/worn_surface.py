"""Worn profile of a face in space, which slides along the face of the other body.

The profile is interpolated between the places of its coefficients, in the plane across the mean
normal of the face, see `plane_cells`. Beyond its outline it is continued by the nearest values.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...errors import CaseError
from ..operators.tangential import middle_in_space
from ..search.pairing import Pairing
from .plane_cells import PlaneCells

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
