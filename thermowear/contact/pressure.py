"""The pressure space: continuous piecewise Bernstein polynomials on the face of body 1.

Bernstein polynomials are nowhere negative and sum to one, so coefficients ``λ >= 0`` mean a
pressure that is nowhere tensile, and each weak gap is a mean of the gap with positive weights.
"""

from __future__ import annotations

import numpy as np
from scipy.special import comb

from .pairing import Pairing


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
    k = np.arange(degree + 1)
    t = side.t[:, None]
    values = comb(degree, k) * t**k * (1 - t) ** (degree - k)
    basis = np.zeros((len(side.t), len(side.face.nodes) * degree + 1))
    np.put_along_axis(basis, side.facet[:, None] * degree + k, values, axis=1)
    return basis[:, pairing.weights @ basis > 0.0]
