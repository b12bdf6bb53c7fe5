"""The steady state, directly from the principle of minimum wear dissipation power."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog

from ..laws import SteadyWear, steady_pressure
from .system import System


def steady_wear(system: System) -> SteadyWear:
    """Steady pressure, wear rates and rigid-body wear velocity of a system."""
    return steady_pressure(
        weights=system.weights,
        normal_modes=system.holder.modes,
        force_modes=system.holder.force_modes,
        load=system.holder.load,
        laws=list(system.laws.values()),
        speed=system.speed,
        spread=list(system.spreads.values()),
    )


def least_worn(
    modes: np.ndarray, opening: np.ndarray, weights: np.ndarray, pressing: np.ndarray
) -> np.ndarray:
    """Motion of the holder at which the faces fit with the least material worn off.

    The depth worn off is ``R d - B u``, nowhere negative where the faces press. With one
    translation of a flat face that is where the highest point is just not worn.

    Parameters
    ----------
    modes : ndarray, shape (n, k)
        R of the free motions.
    opening : ndarray, shape (n,)
        ``B u``, gap that load and heat open [m].
    weights : ndarray, shape (n,) [m²]
    pressing : ndarray of bool, shape (n,)

    Returns
    -------
    ndarray, shape (k,)
    """
    R, size = modes[pressing], np.abs(opening).max() or 1.0
    stretch = np.abs(R).max(axis=0)
    volume = weights[pressing] @ (R / stretch)
    found = linprog(
        volume / np.abs(volume).max(),
        A_ub=-R / stretch,
        b_ub=-opening[pressing] / size,
        bounds=(None, None),
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    return found.x / stretch * size
