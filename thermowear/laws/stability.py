"""Linear stability of a sliding contact with friction heat and wear (perturbation method).

A perturbation ``λ e^{st}`` of the pressure coefficients carries no load and does not change the
contact set; temperatures θ open the weak gap by ``B θ``, and ω is the weak worn depth ::

    A λ + B θ + ω - R d = 0,    Tᵀ λ = 0,
    M dθ/dt + (K + V C) θ = V Q λ,    dω/dt = S λ.

The speed factor V multiplies the speed of the case, and with it friction heat Q λ and advected heat
C. Motions d of the holder are eliminated by spaces Z and Y with ``Tᵀ Z = 0`` and ``Rᵀ Y = 0``. The
static limit is ``(A + V H) λ = R d``: at the critical speed the effective compliance is no longer
definite (J. R. Barber, Proc. R. Soc. A 312 (1969) 381). Growth rates are eigenvalues, possibly
complex (T. A. Dow and R. A. Burton, J. Lubr. Technol. 95 (1973) 71).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from scipy.linalg import null_space, orth, schur

_REAL = 1e-7
"""Imaginary part, relative to the largest eigenvalue, of those that count as real."""
_STATIONARY = 1e-10
"""Growth rate, relative to that of diffusion, below which a mode is stationary."""
_RESOLVED = 1e-13
"""Eigenvalue of a response, relative to the largest, below which it is rounding."""
_RANGE, _STRIDE = 1e5, 1.5
"""Search range of an onset around its start, and step of the search, as speed factors."""


@dataclass(frozen=True)
class LoadFree:
    """Spaces of perturbations that carry no load.

    Attributes
    ----------
    pressures : ndarray, shape (m, m - k)
        Z, a basis of the coefficients with ``Tᵀ λ = 0``.
    gaps : ndarray, shape (m, m - k)
        Y, a basis of the weak means that are invariant to motions of the holder.
    """

    pressures: np.ndarray
    gaps: np.ndarray

    def __call__(self, operator: np.ndarray) -> np.ndarray:
        """Reduce an operator from pressure coefficients to weak gaps, (m, m), to ``Yᵀ O Z``."""
        return self.gaps.T @ operator @ self.pressures


def load_free(modes: np.ndarray, force_modes: np.ndarray) -> LoadFree:
    """Spaces Z and Y of R and T, shape (m, k) each."""
    if modes.shape[1] == 0:
        identity = np.eye(len(modes))
        return LoadFree(identity, identity)
    pressures = _orthogonal(force_modes)
    return LoadFree(pressures, pressures if modes is force_modes else _orthogonal(modes))


def _orthogonal(modes: np.ndarray) -> np.ndarray:
    largest = np.abs(modes).max(axis=0)
    moving = largest > 0.0  # motions of holders that do not touch change nothing
    return null_space((modes[:, moving] / largest[moving]).T)


@dataclass(frozen=True)
class StaticModes:
    """Neutrally stable static perturbations, each at its critical speed.

    Attributes
    ----------
    factors : ndarray, shape (c,)
        Critical speed factors, relative to the given speed, smallest first.
    shapes : ndarray, shape (m, c)
        Pressure coefficients.
    """

    factors: np.ndarray
    shapes: np.ndarray


def static_modes(elastic: np.ndarray, thermal: np.ndarray, space: LoadFree) -> StaticModes:
    """Real positive V and λ with ``(A + V H) λ = R d`` and ``Tᵀ λ = 0``.

    If speed or friction vary along the face the matrices are not symmetric, and some V are complex:
    such modes are oscillatory. The result ends before the first of these.

    Parameters
    ----------
    elastic, thermal : ndarray, shape (m, m)
        A, and H at the given speed.
    space : LoadFree
    """
    inverse, shapes = np.linalg.eig(_influence(elastic, thermal, space))
    size = np.abs(inverse).max(initial=0.0)
    order = np.argsort(-inverse.real)
    swings = np.abs(inverse.imag[order]) > _REAL * size
    falls = inverse.real[order] <= _REAL * size
    chosen = order[: int(np.argmax(np.append(swings | falls, True)))]
    return StaticModes(1 / inverse.real[chosen], space.pressures @ shapes[:, chosen].real)


def leading(
    elastic: np.ndarray, thermal: np.ndarray, depths: np.ndarray, space: LoadFree, count: int
) -> LoadFree:
    """Subspace of the dominant thermal modes, and of pressures due to depths of their shapes.

    The first are spanned by Schur vectors for good conditioning; the second have the peaks at the
    ends of the face that transient perturbations have, too.

    Parameters
    ----------
    elastic, thermal : ndarray, shape (m, m)
        A, and H at the given speed.
    depths : ndarray, shape (m, m)
        Weak depth per coefficient of a depth in the pressure space.
    space : LoadFree
        Full space; returned unless it is more than twice as large as the subspace.
    count : int
        Number of either kind.
    """
    matrix = _influence(elastic, thermal, space)
    if len(matrix) <= 4 * count:
        return space
    least = np.sort(np.abs(np.linalg.eigvals(matrix)))[-count] * (1 - 1e-9)
    _, vectors, found = schur(matrix, sort=lambda re, im=0.0: abs(complex(re, im)) >= least)
    strong = vectors[:, : min(found, count + 1)]  # all are equal without friction heat
    answers = np.linalg.solve(space(elastic), space(depths) @ strong)
    columns = orth(np.hstack([strong, answers / np.linalg.norm(answers, axis=0)]))
    return LoadFree(space.pressures @ columns, space.gaps @ columns)


def _influence(elastic: np.ndarray, thermal: np.ndarray, space: LoadFree) -> np.ndarray:
    """Operator from a pressure to the pressure caused by its friction heat."""
    return -np.linalg.solve(space(elastic), space(thermal))


@dataclass(frozen=True)
class Rate:
    """Growth rate of a perturbation.

    Attributes
    ----------
    value : complex
        Rate s with nonnegative imaginary part [1/s].
    shape : ndarray, shape (q,)
        Pressure shape, in the space of the perturbations.
    """

    value: complex
    shape: np.ndarray


@dataclass(frozen=True)
class PerturbationMatrices:
    """Small dense operators of transient perturbations.

    Attributes
    ----------
    elastic : ndarray, shape (q, q)
        A in the spaces of the perturbations.
    opening : ndarray, shape (q, r)
        B for r thermal coordinates.
    heated : ndarray, shape (r, q)
        Q at the given speed.
    conducted, carried, stored : ndarray, shape (r, r)
        K, C at the given speed, and M.
    diffusion_rate : float
        Rate of heat diffusion across the contact [1/s], the order of the slow rates. Only its order
        of magnitude matters.
    """

    elastic: np.ndarray
    opening: np.ndarray
    heated: np.ndarray
    conducted: np.ndarray
    carried: np.ndarray
    stored: np.ndarray
    diffusion_rate: float

    def fastest(self, factor: float, wear: np.ndarray | None = None) -> Rate | None:
        """Perturbation with the largest growth rate; None if none changes.

        Parameters
        ----------
        factor : float
            Speed factor V.
        wear : ndarray, shape (q, q), optional
            Wear operator S at that speed.
        """
        response, pressure = self._response(factor, wear)
        parts, states = np.linalg.eig(response)
        changing, rates = self._changing(parts)
        if not len(rates):
            return None
        best = int(np.argmax(rates.real))
        value, state = complex(rates[best]), states[:, changing[best]]
        if value.imag < 0:
            value, state = value.conjugate(), state.conj()
        return Rate(value, pressure @ state)

    def growth(self, factor: float, wear: np.ndarray | None = None) -> float:
        """Largest real part of the rates of nonstationary modes [1/s]."""
        _, rates = self._changing(np.linalg.eigvals(self._response(factor, wear)[0]))
        return float(rates.real.max()) if len(rates) else 0.0

    def onset(
        self, start: float, wear: Callable[[float], np.ndarray] | None = None
    ) -> float | None:
        """Critical speed factor, at which perturbations begin to grow: the first above a start.

        If they grow there already, the first below it.

        Parameters
        ----------
        start : float
        wear : callable, optional
            Wear operator S for a speed factor.

        Returns
        -------
        float or None
            None if there is none in the search range.
        """

        def growth(factor: float) -> float:
            return self.growth(factor, None if wear is None else wear(factor))

        factor, grows = start, growth(start) > 0
        while 1 / _RANGE <= factor / start <= _RANGE:
            following = factor / _STRIDE if grows else factor * _STRIDE
            if (growth(following) > 0) != grows:
                ends = sorted((factor, following))
                return float(scipy.optimize.brentq(growth, *ends, xtol=1e-11 * ends[1], rtol=1e-11))
            factor = following
        return None

    def _response(self, factor: float, wear: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
        """Response ``(J - σ E)⁻¹ E`` of temperatures and worn depths x, and their pressures.

        Perturbations follow ``E dx/dt = J x``; σ is the rate of diffusion. Eigenvalues of the
        response are ``1/(s - σ)``, the slow rates its large ones: those of ``E⁻¹ J`` would have
        the rounding errors of the fastest rates, which are larger by many orders of magnitude.
        """
        q, r = len(self.elastic), len(self.stored)
        opened = self.opening if wear is None else np.hstack([self.opening, np.eye(q)])
        pressure = -np.linalg.solve(self.elastic, opened)
        flow = factor * self.heated @ pressure
        flow[:, :r] -= self.conducted + factor * self.carried
        storage = np.eye(len(opened.T))
        storage[:r, :r] = self.stored
        if wear is not None:
            flow = np.vstack([flow, wear @ pressure])
        return np.linalg.solve(flow - self.diffusion_rate * storage, storage), pressure

    def _changing(self, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Indices and rates of the modes that change, by eigenvalues of the response.

        Those that are rounding are left out: their modes decay at once, whatever their sign.
        """
        resolved = np.flatnonzero(np.abs(parts) > _RESOLVED * np.abs(parts).max(initial=0.0))
        rates = self.diffusion_rate + 1 / parts[resolved]
        changes = np.abs(rates) > _STATIONARY * self.diffusion_rate
        return resolved[changes], rates[changes]
