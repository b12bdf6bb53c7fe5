"""State of a frictional interface, with its history variables, and loads that lead to the next."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property

import numpy as np

from ...serialise import serialisable


class Status(IntEnum):
    """Contact status of a coefficient."""

    OPEN = 0
    STICK = 1
    SLIP = 2


@serialisable
@dataclass(frozen=True)
class StickSlipState:
    """State of the interface under load, history variables included.

    Attributes
    ----------
    pressure : ndarray, shape (m,)
        Coefficients λ [Pa].
    shear : ndarray, shape (m, t)
        Coefficients τ of the shear traction on body 1 [Pa].
    slip : ndarray, shape (m, t)
        Weak slip of body 1 over body 2 since the unloaded state, open contact included [m³].
    motion, force : ndarray, shape (k,)
        Motions of the holders and their forces on the bodies [m or rad, N or N m].
    status : ndarray of int, shape (m,)
        `Status` of each coefficient in the last increment.
    point_slip : ndarray, shape (n, t)
        Slip at the points [m].
    dissipated : ndarray, shape (n,)
        Energy ``-∫ t ds`` dissipated at the points so far [J/m²]. Its integral is exactly that of
        the weak conditions, to which each coefficient contributes at least 0; values at points of
        stick zones scatter about zero as the slip does.
    worn : ndarray, shape (n_wearing, m_Ψ)
        Coefficients of the worn profiles so far [m].
    part, onset, unsheared, excess, unrelieved : ndarray, shape (m,)
        Part of each coefficient that stuck in the last cycle, and the least one so far; of those
        across the stick edge the pressure that bears no shear [Pa]; the depth worn since there is a
        stick zone, outside of it, and what it were if wear relieved no pressure there [m]; see
        `stick_edge`.
    spared : ndarray, shape (m,)
        Weak gap by wear next to stick zones, see `FrictionalContact.spared` [m³].
    iterations : int
        Newton iterations of the last increment.
    """

    pressure: np.ndarray
    shear: np.ndarray
    slip: np.ndarray
    motion: np.ndarray
    force: np.ndarray
    status: np.ndarray
    point_slip: np.ndarray
    dissipated: np.ndarray
    worn: np.ndarray
    part: np.ndarray
    onset: np.ndarray
    unsheared: np.ndarray
    excess: np.ndarray
    unrelieved: np.ndarray
    spared: np.ndarray
    iterations: int = 0

    @cached_property
    def crossed(self) -> np.ndarray:
        """True for coefficients of which a part sticks, shape (m,)."""
        return (self.part > 0.0) & (self.part < 1.0)

    @property
    def not_sticking(self) -> np.ndarray:
        """True for coefficients that slipped or were open in the last increment, shape (m,)."""
        return self.status != Status.STICK


@dataclass(frozen=True)
class Loads:
    """Force or displacement along each motion of the holders at one instant.

    Attributes
    ----------
    forces : ndarray, shape (k,)
        Generalised force of the holder, NaN if the motion is given [N or N m].
    motions : ndarray, shape (k,)
        Amount of the motion, NaN if the force is given [m or rad].

    Raises
    ------
    ValueError
        Unless exactly one of them is given along each motion.
    """

    forces: np.ndarray
    motions: np.ndarray

    def __post_init__(self):
        if np.any(np.isnan(self.forces) == np.isnan(self.motions)):
            raise ValueError("loads: give either force or translation along each motion")

    def after(self, force: np.ndarray, motion: np.ndarray, part: float) -> Loads:
        """Loads interpolated linearly from a state to these loads.

        Parameters
        ----------
        force, motion : ndarray, shape (k,)
            Forces and motions of the holders in that state.
        part : float
            0 at the state, 1 at these loads.
        """
        return Loads(
            (1 - part) * force + part * self.forces, (1 - part) * motion + part * self.motions
        )
