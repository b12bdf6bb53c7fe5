"""Linear stability of sliding contact against waves that travel along the sliding direction.

A perturbation ``exp(i m x + s t)`` of the pressure coefficients λ, in the frame of a reference
body, has the rate ``s_b = s + i V ω_b`` in the frame of body b, which passes the reference body at
V times the given velocity, ``ω_b`` times the wave length per radian. Temperatures θ and worn depths
of the bodies then obey ::

    A λ + B θ + Σ_b V S_b λ / s_b = R d,    Tᵀ λ = 0,    (K + s_b M) θ = V Q λ,

with the matrices of `laws.stability` (R. A. Burton, V. Nerlikar and S. R. Kilaparti, Wear 24 (1973)
177; K. Lee and J. R. Barber, J. Tribol. 115 (1993) 607). A mode is a zero of the determinant in s;
at a critical speed one of them is imaginary, and the wave travels at ``-Im s / m`` on the reference
body.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

_MINIMUM_DEGREE, _AS_ORDERED = "MMD_AT_PLUS_A", "NATURAL"
_PIVOTING = {"diag_pivot_thresh": 0.01, "options": {"SymmetricMode": True}}
"""Options of the factor of nearly symmetric matrices."""
_LEAST = 1e-9
"""Rate in place of zero in the frame of a worn body, relative to that of diffusion."""


@dataclass(frozen=True)
class WornBody:
    """Wear of the faces of one body.

    Attributes
    ----------
    rate : ndarray, shape (q, q)
        S_b: weak wear rate per pressure coefficient at the given speed.
    turning : float
        ω_b [rad/s].
    """

    rate: np.ndarray
    turning: float


@dataclass(frozen=True)
class Gains:
    """Eigenvalues g and eigenvectors of the operator from a pressure to that by its own heat.

    Attributes
    ----------
    values : ndarray, shape (q,)
        Complex; a mode has ``g = 1``.
    shapes : ndarray, shape (q, q)
    """

    values: np.ndarray
    shapes: np.ndarray

    def like(self, shape: np.ndarray) -> tuple[complex, np.ndarray]:
        """Eigenvalue whose eigenvector is most similar to a shape (q,)."""
        one = int(np.argmax(np.abs(shape.conj() @ self.shapes)))
        return complex(self.values[one]), self.shapes[:, one]

    @property
    def largest(self) -> tuple[complex, np.ndarray]:
        """Eigenvalue with the largest real part."""
        one = int(np.argmax(self.values.real))
        return complex(self.values[one]), self.shapes[:, one]


@dataclass(frozen=True)
class OrderedHeat:
    """Matrices of `WaveEquations` in another order of the temperatures.

    Attributes
    ----------
    conducted, stored, carried : csc_matrix, shape (n, n)
        K, M, and M with the rows of each body times its ω_b.
    heated : ndarray, shape (n, q)
    opening : ndarray, shape (q, n)
        Complex, as what they are multiplied by.
    order : ndarray of int, shape (n,)
        Numbers of the temperatures in this order.
    """

    conducted: sp.csc_matrix
    stored: sp.csc_matrix
    carried: sp.csc_matrix
    heated: np.ndarray
    opening: np.ndarray
    order: np.ndarray

    def solved(self, factor: float, rate: complex) -> np.ndarray:
        """Temperatures (n, q), see `WaveEquations.temperatures`."""
        matrix = self.conducted + rate * self.stored + 1j * factor * self.carried
        factors = splu(matrix.tocsc(), permc_spec=_AS_ORDERED, **_PIVOTING)
        return factors.solve(factor * self.heated)


@dataclass(frozen=True)
class WaveEquations:
    """Equations of the perturbations of one wave length.

    Attributes
    ----------
    elastic : ndarray, shape (q, q)
        A of the perturbations without resultants.
    opening : ndarray, shape (q, n)
        B.
    heated : ndarray, shape (n, q)
        Q at the given speed.
    conducted, stored : csc_matrix, shape (n, n)
        K and M.
    turning : ndarray, shape (n,)
        ω_b of the body of each temperature [rad/s].
    worn : tuple of WornBody
    slowest : float
        Rate of heat diffusion over a wave length, the scale of the rates [1/s].
    frames : tuple of float
        ω_b of the bodies that conduct heat, the reference body's first [rad/s].
    """

    elastic: np.ndarray
    opening: np.ndarray
    heated: np.ndarray
    conducted: sp.csc_matrix
    stored: sp.csc_matrix
    turning: np.ndarray
    worn: tuple[WornBody, ...]
    slowest: float
    frames: tuple[float, ...]

    @property
    def without_wear(self) -> WaveEquations:
        """Equations of the same bodies without wear."""
        return replace(self, worn=())

    def with_wear_times(self, factor: float) -> WaveEquations:
        """Equations with other wear rates by a factor."""
        return replace(self, worn=tuple(replace(w, rate=factor * w.rate) for w in self.worn))

    @cached_property
    def _ordered(self) -> OrderedHeat:
        """Matrices in an order of little fill, which is the same at all speeds and rates."""
        pattern = (self.conducted + self.stored).tocsc()
        order = np.argsort(splu(pattern, permc_spec=_MINIMUM_DEGREE, **_PIVOTING).perm_c)
        carried = sp.diags(self.turning) @ self.stored
        conducted, stored, moved = (
            sp.csc_matrix(matrix[order][:, order])
            for matrix in (self.conducted.tocsr(), self.stored.tocsr(), carried.tocsr())
        )
        heated, opening = self.heated[order] + 0j, self.opening[:, order] + 0j
        return OrderedHeat(conducted, stored, moved, heated, opening, order)

    def temperatures(self, factor: float, rate: complex) -> np.ndarray:
        """Temperatures (n, q) per pressure coefficient at a speed factor and a rate s [K/Pa]."""
        result = np.empty(self.heated.shape, dtype=complex)
        result[self._ordered.order] = self._ordered.solved(factor, rate)
        return result

    def flexibility(self, factor: float, rate: complex) -> np.ndarray:
        """Weak gap per pressure coefficient by deflection and wear, (q, q)."""
        result = self.elastic.astype(complex)
        for body in self.worn:
            own = rate + 1j * factor * body.turning
            result += factor / (own or _LEAST * self.slowest) * body.rate
        return result

    def influence(self, factor: float, rate: complex) -> np.ndarray:
        """Operator from a pressure to the pressure by its friction heat, (q, q)."""
        opened = self._ordered.opening @ self._ordered.solved(factor, rate)
        return -np.linalg.solve(self.flexibility(factor, rate), opened)

    def gains(self, factor: float, rate: complex) -> Gains:
        """Eigenvalues and eigenvectors of `influence`."""
        return Gains(*np.linalg.eig(self.influence(factor, rate)))

    def determinant(self, factor: float, rate: complex) -> complex:
        """Determinant of ``1 - influence``, which tends to 1 for high rates; without wear."""
        matrix = -self.without_wear.influence(factor, rate)
        matrix[np.diag_indices(len(matrix))] += 1.0
        return complex(np.linalg.det(matrix))
