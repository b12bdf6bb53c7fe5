"""State of an interface with friction under loads that change: what friction remembers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from ...serialise import serialisable
from ..operators.tangential import FrictionalContact


class Status(IntEnum):
    """Of a coefficient."""

    OPEN = 0
    STICK = 1
    SLIP = 2


@serialisable
@dataclass(frozen=True)
class StickSlipState:
    """The interface under load, and what it remembers.

    Attributes
    ----------
    pressure : ndarray, shape (m,)
        Coefficients λ [Pa].
    shear : ndarray, shape (m, t)
        Coefficients τ of the traction on body 1 [Pa].
    slip : ndarray, shape (m, t)
        Of body 1 over body 2 since the unloaded state, in the mean, open or not [m³].
    motion, force : ndarray, shape (k,)
        Translations of the holder and its forces on body 1 [m, N].
    status : ndarray of int, shape (m,)
        `Status` of each coefficient in the last increment.
    point_slip : ndarray, shape (n, t)
        Slip at the points [m].
    dissipated : ndarray, shape (n,)
        Energy ``-∫ t ds`` lost at the points so far [J/m²]. Its integral is exactly that of the
        conditions in the mean, where each coefficient's share is never negative; values at single
        points of sticking zones scatter about zero as the slip there does.
    worn : ndarray, shape (n_wearing, m)
        Coefficients of the depths worn off so far [m].
    iterations : int
        Of Newton's method in the last increment.
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
    iterations: int = 0

    @property
    def moves(self) -> np.ndarray:
        """Which coefficients slipped, or were open, in the last increment, shape (m,)."""
        return self.status != Status.STICK


def unloaded(contact: FrictionalContact, wearing: int = 0) -> StickSlipState:
    """The state before any load, of bodies of which so many wear."""
    (n, m), k = contact.basis.shape, contact.modes.shape[1]
    t = len(contact.response) - 1
    still, free = np.zeros(k), np.full(m, Status.OPEN)
    coefficients, points, worn = np.zeros((m, t)), np.zeros((n, t)), np.zeros((wearing, m))
    return StickSlipState(
        np.zeros(m), coefficients, coefficients, still, still, free, points, np.zeros(n), worn
    )


def stored_energy(contact: FrictionalContact, state: StickSlipState) -> float:
    """Elastic energy ``xᵀ A x / 2`` of both bodies [J]."""
    x = contact.stack(state.pressure, state.shear)
    return float(x @ contact.compliance @ x) / 2
