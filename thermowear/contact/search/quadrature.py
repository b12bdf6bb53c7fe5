"""Quadrature rules on [0, 1] and on the unit square."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre


@lru_cache(maxsize=32)
def lobatto(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and weights of the n-point Gauss-Lobatto rule, exact to degree ``2 n - 3``.

    Both ends are quadrature points. The inner points are the roots of the derivative of the
    Legendre polynomial of degree n - 1 (Abramowitz and Stegun, 25.4.32).
    """
    if n < 2:
        raise ValueError("a Gauss-Lobatto rule has at least two points")
    coefficients = np.zeros(n)
    coefficients[-1] = 1.0
    inner = np.sort(legendre.legroots(legendre.legder(coefficients)).real)
    x = np.concatenate([[-1.0], inner, [1.0]])
    w = 2.0 / (n * (n - 1) * legendre.legval(x, coefficients) ** 2)
    return (x + 1) / 2, w / 2


def gauss(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and weights of the n-point Gauss-Legendre rule, exact to degree ``2 n - 1``."""
    x, w = legendre.leggauss(n)
    return (x + 1) / 2, w / 2


def square(x: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Tensor-product rule on the unit square: points of shape (n², 2), weights (n²,)."""
    s, t = np.meshgrid(x, x, indexing="ij")
    return np.column_stack([s.ravel(), t.ravel()]), np.outer(w, w).ravel()
