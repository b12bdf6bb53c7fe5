"""Static thermoelastic stability of a contact zone on the condensed interface."""

from __future__ import annotations

import numpy as np
import scipy.linalg

_REAL = 1e-9
"""Imaginary part, relative to the eigenvalue, below which a mode does not swing."""


def critical_factor(
    compliance: np.ndarray, thermal: np.ndarray, modes: np.ndarray, active: np.ndarray
) -> float:
    """Least part of its friction heat by which a pressure of a contact zone maintains itself.

    With the compliance A and the thermal distortion H by the heat of the pressure, a pressure
    without resultant that keeps the faces closed under a part s of the heat satisfies
    ``(A + s H) λ = R d``. The least s > 0 is the critical speed factor of static modes
    (R. A. Burton et al., Wear 24 (1973) 177), infinite without any; the state is unstable if it
    is less than 1.

    Parameters
    ----------
    compliance, thermal : ndarray, shape (m, m)
        A and H.
    modes : ndarray, shape (m, k)
        Rigid-body modes R of the holder.
    active : ndarray of bool, shape (m,)
        Coefficients in contact.
    """
    free = scipy.linalg.null_space(modes[active].T) if modes.shape[1] else np.eye(active.sum())
    if not free.shape[1]:
        return np.inf
    elastic, hot = (free.T @ each[np.ix_(active, active)] @ free for each in (compliance, thermal))
    values = scipy.linalg.eigvals(np.linalg.solve(elastic, hot))
    static = values.real[np.abs(values.imag) <= _REAL * np.abs(values)]
    least = static.min(initial=0.0)
    return -1 / float(least) if least < 0.0 else np.inf
