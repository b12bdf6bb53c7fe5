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
class WaveHeat:
    """Conduction of a wave, and the gap that its temperatures open.

    Attributes
    ----------
    opening : ndarray, shape (q, n)
        B.
    heated : ndarray, shape (n, q)
        Q at the given speed.
    conducted, stored : csc_matrix, shape (n, n)
        K and M.
    turning : ndarray, shape (n,)
        ω_b of the body of each temperature [rad/s].
    """

    opening: np.ndarray
    heated: np.ndarray
    conducted: sp.csc_matrix
    stored: sp.csc_matrix
    turning: np.ndarray

    def temperatures(self, factor: float, rate: complex) -> np.ndarray:
        """Temperatures (n, q) per pressure coefficient at a speed factor and a rate s [K/Pa]."""
        result = np.empty(self.heated.shape, dtype=complex)
        result[self._ordered.order] = self._ordered.solved(factor, rate)
        return result

    def opened(self, factor: float, rate: complex) -> np.ndarray:
        """Weak gap per pressure coefficient by friction heat, (q, q)."""
        return self._ordered.opening @ self._ordered.solved(factor, rate)

    @cached_property
    def _ordered(self) -> OrderedHeat:
        """Matrices in an order of little fill, which is the same at all speeds and rates."""
        pattern = (abs(self.conducted) + abs(self.stored)).tocsc()
        order = np.argsort(splu(pattern, permc_spec=_MINIMUM_DEGREE, **_PIVOTING).perm_c)
        carried = sp.diags(self.turning) @ self.stored
        pattern, *matrices = (
            sp.csc_matrix(matrix.tocsr()[order][:, order])
            for matrix in (pattern, self.conducted, self.stored, carried)
        )
        pattern.sort_indices()
        conducted, stored, moved = (_values_at(pattern, matrix) for matrix in matrices)
        heated, opening = self.heated[order] + 0j, self.opening[:, order] + 0j
        return OrderedHeat(pattern, conducted, stored, moved, heated, opening, order)


@dataclass(frozen=True)
class OrderedHeat:
    """Matrices of `WaveHeat` in another order of the temperatures, all with the same pattern.

    Attributes
    ----------
    pattern : csc_matrix, shape (n, n)
    conducted, stored, carried : ndarray, shape (nnz,)
        Entries of K, of M, and of M with the rows of each body times its ω_b.
    heated : ndarray, shape (n, q)
    opening : ndarray, shape (q, n)
        Complex, as what they are multiplied by.
    order : ndarray of int, shape (n,)
        Numbers of the temperatures in this order.
    """

    pattern: sp.csc_matrix
    conducted: np.ndarray
    stored: np.ndarray
    carried: np.ndarray
    heated: np.ndarray
    opening: np.ndarray
    order: np.ndarray

    def solved(self, factor: float, rate: complex) -> np.ndarray:
        """Temperatures (n, q) in this order, see `WaveHeat.temperatures`."""
        values = self.conducted + rate * self.stored + 1j * factor * self.carried
        pattern = self.pattern
        matrix = sp.csc_matrix((values, pattern.indices, pattern.indptr), pattern.shape)
        factors = splu(matrix, permc_spec=_AS_ORDERED, **_PIVOTING)
        return factors.solve(factor * self.heated)


def _values_at(pattern: sp.csc_matrix, matrix: sp.csc_matrix) -> np.ndarray:
    """Entries of a matrix at those of a pattern with sorted indices that contains its own."""
    values = np.zeros(pattern.nnz)
    values[np.searchsorted(_places(pattern), _places(matrix))] = matrix.data
    return values


def _places(matrix: sp.csc_matrix) -> np.ndarray:
    """Numbers of the entries of a matrix, column by column."""
    columns = np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr))
    return columns * matrix.shape[0] + matrix.indices


@dataclass(frozen=True)
class WaveEquations:
    """Equations of the perturbations of one wave length.

    Attributes
    ----------
    elastic : ndarray, shape (q, q)
        A of the perturbations without resultants.
    heat : WaveHeat
    worn : tuple of WornBody
    slowest : float
        Rate of heat diffusion over a wave length, the scale of the rates [1/s].
    frames : tuple of float
        ω_b of the bodies that conduct heat, the reference body's first [rad/s].
    """

    elastic: np.ndarray
    heat: WaveHeat
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

    def flexibility(self, factor: float, rate: complex) -> np.ndarray:
        """Weak gap per pressure coefficient by deflection and wear, (q, q)."""
        result = self.elastic.astype(complex)
        for body in self.worn:
            own = rate + 1j * factor * body.turning
            result += factor / (own or _LEAST * self.slowest) * body.rate
        return result

    def influence(self, factor: float, rate: complex) -> np.ndarray:
        """Operator from a pressure to the pressure by its friction heat, (q, q)."""
        return -np.linalg.solve(self.flexibility(factor, rate), self.heat.opened(factor, rate))

    def gains(self, factor: float, rate: complex) -> Gains:
        """Eigenvalues and eigenvectors of `influence`."""
        return Gains(*np.linalg.eig(self.influence(factor, rate)))

    def determinant(self, factor: float, rate: complex) -> complex:
        """Determinant of ``1 - influence``, which tends to 1 for high rates; without wear."""
        matrix = -self.without_wear.influence(factor, rate)
        matrix[np.diag_indices(len(matrix))] += 1.0
        return complex(np.linalg.det(matrix))
