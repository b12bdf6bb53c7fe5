"""Pressure space: continuous piecewise Bernstein polynomials on the face of body 1.

On quadrilaterals they are tensor products in both parameters. Bernstein polynomials are
nonnegative and sum to one, so that coefficients ``λ >= 0`` give a pressure without tension, and
each weak gap is a mean of the gap with nonnegative weights.
"""

from __future__ import annotations

import numpy as np
from scipy.special import comb, factorial

from ...lagrange import lattice
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
    t = side.t.reshape(len(side.facet), -1)
    values = _on_triangles(degree, t) if side.face.kind == "triangle" else _on_products(degree, t)
    numbers = side.face.numbers(degree)
    basis = np.zeros((len(side.facet), numbers.max() + 1))
    np.put_along_axis(basis, numbers[side.facet], values, axis=1)
    return basis[:, pairing.weights @ basis > 0.0]


def _on_products(degree: int, t: np.ndarray) -> np.ndarray:
    """Products of Bernstein polynomials of each parameter, shape (n, (degree + 1)**dim)."""
    values = np.ones((len(t), 1))
    for along in t.T:
        values = (values[:, :, None] * _bernstein(degree, along)[:, None]).reshape(len(t), -1)
    return values


def _on_triangles(degree: int, t: np.ndarray) -> np.ndarray:
    """Bernstein polynomials of a triangle in the order of its lattice.

    Shape (n, (degree + 1) (degree + 2) / 2).
    """
    powers = np.rint(lattice(degree, "triangle") * degree)
    powers = np.column_stack([powers, degree - powers.sum(axis=1)])
    parts = np.column_stack([t, np.maximum(1.0 - t.sum(axis=1), 0.0)])
    scale = factorial(degree) / factorial(powers).prod(axis=1)
    return scale * (parts[:, None] ** powers).prod(axis=2)


def _bernstein(degree: int, t: np.ndarray) -> np.ndarray:
    """Bernstein polynomials on [0, 1], shape (n, degree + 1)."""
    k = np.arange(degree + 1)
    return comb(degree, k) * t[:, None] ** k * (1 - t[:, None]) ** (degree - k)
