"""Frictional contact of bodies that are held: pressures, shears and slips; signs: `tangential`."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..operators.pressure import PressureSpace
from ..operators.tangential import HeldMotion
from .increment_wear import WearSlope
from .slip_wear import AnyProfiles, WornProfiles
from .stick_slip_state import Loads, Status, StickSlipState


@dataclass(frozen=True)
class FrictionalContact(PressureSpace):
    """Contact with friction, condensed or on the full system: solves one increment.

    Below, t tangential directions give ``M = m (1 + t)`` coefficients.

    Attributes
    ----------
    gap : ndarray, shape (n,)
        Gap of the unloaded, unworn bodies [m].
    rigid : ndarray, shape (1 + t, n, k)
        R at the points: decrease of gap and slips per unit of each motion of the holder.
    modes : ndarray, shape (M, k)
        Weak R [m²].
    travel : ndarray, shape (n_interfaces, k), in space (n_interfaces, 3, k)
        Displacement of the first body over the second one in the middle of the face per unit of
        each motion: along increasing positions on the face; in space along the axes of the frame
        there, and rotation about its pole, see `faces.tangent_frame`.
    held : tuple of HeldMotion
        The k motions.
    """

    gap: np.ndarray
    rigid: np.ndarray
    modes: np.ndarray
    travel: np.ndarray
    held: tuple[HeldMotion, ...]

    @property
    def directions(self) -> int:
        """Number t of tangential directions."""
        return len(self.rigid) - 1

    @cached_property
    def areas(self) -> np.ndarray:
        """Areas of the basis functions, shape (m,) [m²]."""
        return np.asarray(self.weighted.sum(axis=0)).ravel()

    def with_role(self, role: str) -> np.ndarray:
        """True for the motions with a role, shape (k,)."""
        return np.array([motion.role == role for motion in self.held], dtype=bool)

    def stack(self, pressure: np.ndarray, shear: np.ndarray) -> np.ndarray:
        """Coefficients λ, shape (m,), and τ, shape (m, t), as one vector x."""
        return np.concatenate([pressure, shear.T.ravel()])

    def split(self, stacked: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Split x into λ and τ, the inverse of `stack`."""
        blocks = stacked.reshape(-1, self.basis.shape[1])
        return blocks[0], blocks[1:].T

    def seen(self, profiles: WornProfiles) -> AnyProfiles:
        """Worn profiles in the basis of the contact, by default their own."""
        return profiles

    @abstractmethod
    def increment(
        self,
        friction: np.ndarray,
        state: StickSlipState,
        guess: StickSlipState,
        loads: Loads,
        worn: np.ndarray,
        lost: np.ndarray | None = None,
        slope: WearSlope | None = None,
    ) -> StickSlipState:
        """State after one implicit increment, without a change of its worn depths.

        Parameters
        ----------
        friction : ndarray, shape (m,)
            Coefficient of friction.
        state : StickSlipState
            State before the increment.
        guess : StickSlipState
            The same, or a state with the same loads.
        loads : Loads
            Loads at the end of the increment.
        worn : ndarray, shape (m,)
            Worn depth before the increment, at the places of its end [m].
        lost : ndarray, shape (m,), optional
            Depth that it wears at zero pressure [m].
        slope : WearSlope, optional
            Depth that it wears per pressure [m/Pa].

        Raises
        ------
        FullSliding
            If the tangential force exceeds the friction limit.
        ComputationError
            If no solution is found.
        """

    def spared(self, state: StickSlipState, after: StickSlipState) -> np.ndarray:
        """Weak gaps by worn depths beyond those of functions that overlap, shape (m, m) [m²].

        What is worn next to the stick zone would open the gap within it, so that its edge slips and
        wears, and so on. There, functions have the gap of their own depth alone; those outside
        share theirs as they slip.
        """
        return np.zeros((len(self.areas),) * 2)

    @abstractmethod
    def lost(self, shear: np.ndarray, slip: np.ndarray, point_slip: np.ndarray) -> np.ndarray:
        """Energy dissipated at the points in an increment, shape (n,) [J/m²].

        Its integral is exactly that of the weak conditions, to which each coefficient contributes
        at least 0.

        Parameters
        ----------
        shear : ndarray, shape (m, t)
            Coefficients τ at the end of the increment [Pa].
        slip : ndarray, shape (m, t)
            Weak slip of the increment [m³].
        point_slip : ndarray, shape (n, t)
            Slip of the increment at the points [m].
        """


def unloaded(
    contact: FrictionalContact, wearing: int = 0, coefficients: int | None = None
) -> StickSlipState:
    """Unloaded initial state.

    Parameters
    ----------
    contact : FrictionalContact
    wearing : int
        Number of wearing bodies.
    coefficients : int, optional
        Number of coefficients of each worn profile, by default that of the contact.
    """
    (n, m), k = contact.basis.shape, contact.modes.shape[1]
    t = contact.directions
    still, free = np.zeros(k), np.full(m, Status.OPEN)
    shears, points = np.zeros((m, t)), np.zeros((n, t))
    worn = np.zeros((wearing, m if coefficients is None else coefficients))
    none = np.zeros(m)
    return StickSlipState(
        none, shears, shears, still, still, free, points, np.zeros(n), worn, *(none,) * 6
    )
