"""Smoothing of worn faces to pointwise conformity where they press."""

from __future__ import annotations

import numpy as np

from ...contact.wear.unresolved_gap import unresolved_gap
from ...laws.distribution import InPlace
from ..interface.interface_problem import InterfaceProblem
from ..interface.sdirk import InterfaceState
from ..results.recording import snapshot_at


def smoothed_wear(problem: InterfaceProblem, state: InterfaceState, time: float) -> np.ndarray:
    """Worn depths with pointwise conforming faces where they press. Every rank calls.

    The gap is changed only orthogonally to the pressure space: pressure, forces and volumes stay.
    The change is shared by the bodies worn in place, in proportion to their depths.

    Returns
    -------
    ndarray, shape (n_wearing, n)
        [m]; those of the state if any of them became negative otherwise.
    """
    system, gap = problem.system, snapshot_at(problem, state, time).interface.gap
    weak = state.pressure > 0
    if state.pointwise is not None:
        weak &= ~state.pointwise  # there faces conform already, and the gap is resolved
    excess = unresolved_gap(gap, weak, system.pairing, system.basis)
    in_place = np.array([isinstance(s, InPlace) for s in system.spreads.values()])
    ours = np.where(in_place[:, None], state.worn, 0.0)
    whole = ours.sum(axis=0)
    shares = np.divide(ours, whole, out=np.zeros_like(ours), where=whole > 0.0)
    found = state.worn - shares * excess
    return found if np.all(found >= 0.0) else state.worn
