"""The part of a gap that no basis function of the pressure sees.

Contact closes the gap in the mean of each basis function, not point by point. Where faces wear on
and on, what is left between these means grows with the wear, though no pressure answers it.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ..search.pairing import Pairing


def unseen(gap: np.ndarray, pressing: np.ndarray, pairing: Pairing, basis: np.ndarray):
    """What can be taken from a gap without any change of its means over basis functions.

    The gap less its projection on the pressure space of those facets that press all over, in the
    mean of squares over the area; zero on all others.

    Parameters
    ----------
    gap : ndarray, shape (n,)
        At the contact points [m].
    pressing : ndarray of bool, shape (n,)
    pairing : Pairing
    basis : ndarray, shape (n, m)
        Ψ, see `pressure.pressure_basis`.

    Returns
    -------
    ndarray, shape (n,)
        ``Ψᵀ w`` of it vanishes [m].
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
    means = np.linalg.norm(on_closed, axis=0)  # some reach in but a little
    factor = cho_factor((weighted / means).T @ (on_closed / means))
    amounts = cho_solve(factor, (weighted / means).T @ gap[closed]) / means
    result[closed] = gap[closed] - on_closed @ amounts
    return result
