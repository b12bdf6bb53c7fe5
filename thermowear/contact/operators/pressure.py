"""The pressure space: continuous piecewise Bernstein polynomials on the face of body 1.

On a surface they are products of polynomials of both parameters. Bernstein polynomials are nowhere
negative and sum to one, so coefficients ``λ >= 0`` mean a pressure that is nowhere tensile, and
each weak gap is a mean of the gap with positive weights.
"""

from __future__ import annotations

import numpy as np
from scipy.special import comb

from ..search.pairing import Pairing


def pressure_basis(pairing: Pairing, degree: int) -> np.ndarray:
    """Ψ: values of the basis functions at the contact points.

    Parameters
    ----------
    pairing : Pairing
    degree : int
        At least 1; one or two below the displacement keeps the space stable.

    Returns
    -------
    ndarray, shape (n_points, n_functions)
        Functions without any contact point in their support are left out.
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
