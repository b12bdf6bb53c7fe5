"""Gap component orthogonal to the pressure space.

Weak contact closes the mean of the gap with each basis function, not the gap at each point. Under
continued wear the component orthogonal to all basis functions grows without effect on the pressure.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ..search.pairing import Pairing


def unresolved_gap(gap: np.ndarray, pressing: np.ndarray, pairing: Pairing, basis: np.ndarray):
    """Gap component orthogonal to the pressure space, on fully closed facets.

    The gap less its L² projection on the pressure space of the fully closed facets; zero on all
    others.

    Parameters
    ----------
    gap : ndarray, shape (n,)
        Gap at the contact points [m].
    pressing : ndarray of bool, shape (n,)
    pairing : Pairing
    basis : ndarray, shape (n, m)
        Ψ, see `pressure.pressure_basis`.

    Returns
    -------
    ndarray, shape (n,)
        Component whose weak values ``Ψᵀ w v`` vanish [m].
    """
    facet = pairing.sides[0].facet
    open_somewhere = np.zeros(facet.max() + 1, dtype=bool)
    open_somewhere[facet[~pressing]] = True
    closed = ~open_somewhere[facet]
    result = np.zeros_like(gap)
    if not closed.any():
        return result
    on_closed = basis[closed]
    on_closed = on_closed[:, np.abs(on_closed).max(axis=0) > 0.0]
    weighted = pairing.weights[closed, None] * on_closed
    means = np.linalg.norm(on_closed, axis=0)  # some have little support there
    factor = cho_factor((weighted / means).T @ (on_closed / means))
    coefficients = cho_solve(factor, (weighted / means).T @ gap[closed]) / means
    result[closed] = gap[closed] - on_closed @ coefficients
    return result
