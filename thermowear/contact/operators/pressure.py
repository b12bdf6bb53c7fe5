"""Pressure space: continuous piecewise Bernstein polynomials on the face of body 1.

On a surface they are tensor products in both parameters. Bernstein polynomials are nonnegative and
sum to one, so that coefficients ``λ >= 0`` give a pressure without tension, and each weak gap is a
mean of the gap with nonnegative weights.
"""

from __future__ import annotations

import numpy as np
from scipy.special import comb

from ..search.pairing import Pairing


def pressure_basis(pairing: Pairing, degree: int) -> np.ndarray:
    """Values Ψ of the basis functions at the contact points.

    Parameters
    ----------
    pairing : Pairing
    degree : int
        At least 1; one or two below that of the displacement for a stable space.

    Returns
    -------
    ndarray, shape (n_points, n_functions)
        Functions without contact points in their support are omitted.
    """
    side = pairing.sides[0]
    values = np.ones((len(side.facet), 1))
    for t in side.t.reshape(len(side.facet), -1).T:
        values = (values[:, :, None] * _bernstein(degree, t)[:, None]).reshape(len(values), -1)
    numbers = side.face.numbers(degree).reshape(len(side.face.nodes), -1)
    basis = np.zeros((len(side.facet), numbers.max() + 1))
    np.put_along_axis(basis, numbers[side.facet], values, axis=1)
    return basis[:, pairing.weights @ basis > 0.0]


def _bernstein(degree: int, t: np.ndarray) -> np.ndarray:
    """Bernstein polynomials on [0, 1], shape (n, degree + 1)."""
    k = np.arange(degree + 1)
    return comb(degree, k) * t[:, None] ** k * (1 - t[:, None]) ** (degree - k)
