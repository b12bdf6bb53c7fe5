"""Small disturbances of a sliding contact with friction heat and wear: which of them grow.

A disturbance ``λ e^{st}`` of the pressure coefficients carries no load and keeps closed what
touches; temperatures θ open the weak gap by ``B θ``, and ω is the weak depth that is worn off ::

    A λ + B θ + ω - R d = 0,    Tᵀ λ = 0,
    M dθ/dt + (K + V C) θ = V Q λ,    dω/dt = S λ.

V multiplies the speed of the case: friction heat Q λ goes with it, and heat C that is carried
along. Motions d of the holder are taken out by spaces Z and Y with ``Tᵀ Z = 0`` and ``Rᵀ Y = 0``.
Without anything that changes in time that is ``(A + V H) λ = R d``: the critical speed makes the
effective compliance lose its definiteness (J. R. Barber, Proc. R. Soc. A 312 (1969) 381). Rates
are eigenvalues; they may be complex (T. A. Dow and R. A. Burton, J. Lubr. Technol. 95 (1973) 71).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space, orth, schur
from scipy.optimize import brentq

_REAL = 1e-7
"""Imaginary part, relative to the largest eigenvalue, of those that count as real."""
_ROUNDING = 1e-13
"""Relative growth rate, by the largest one, below which a mode is stationary."""
_RANGE, _STRIDE = 1e5, 1.5
"""Search range of an onset around its start, and step of the search: factors of the speed."""


@dataclass(frozen=True)
class LoadFree:
    """Disturbances that carry no load.

    Attributes
    ----------
    pressures : ndarray, shape (m, m - k)
        Z: columns span the coefficients with ``Tᵀ λ = 0``.
    gaps : ndarray, shape (m, m - k)
        Y: columns span the weak means to which motions of the holder do nothing.
    """

    pressures: np.ndarray
    gaps: np.ndarray

    def __call__(self, operator: np.ndarray) -> np.ndarray:
        """``Yᵀ O Z`` of an operator from pressure coefficients to weak gaps, shape (m, m)."""
        return self.gaps.T @ operator @ self.pressures

    def narrowed(self, columns: np.ndarray) -> LoadFree:
        """To combinations of the columns."""
        return LoadFree(self.pressures @ columns, self.gaps @ columns)


def load_free(modes: np.ndarray, force_modes: np.ndarray) -> LoadFree:
    """The spaces Z and Y of R and T, shape (m, k) each."""
    if modes.shape[1] == 0:
        identity = np.eye(len(modes))
        return LoadFree(identity, identity)
    pressures = _orthogonal(force_modes)
    return LoadFree(pressures, pressures if modes is force_modes else _orthogonal(modes))


def _orthogonal(modes: np.ndarray) -> np.ndarray:
    return null_space((modes / np.abs(modes).max(axis=0)).T)


@dataclass(frozen=True)
class StaticModes:
    """Disturbances that neither grow nor die out, each at its own speed.

    Attributes
    ----------
    factors : ndarray, shape (c,)
        Of the given speed, smallest first.
    shapes : ndarray, shape (m, c)
        Pressure coefficients.
    """

    factors: np.ndarray
    shapes: np.ndarray


def static_modes(elastic: np.ndarray, thermal: np.ndarray, space: LoadFree) -> StaticModes:
    """Real positive V and λ with ``(A + V H) λ = R d`` and ``Tᵀ λ = 0``.

    Where speed or friction differ along the face the matrices are not symmetric, and some V are
    complex: such disturbances never stay, they swing. Given are those up to the first of these.

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
    """The disturbances that heat acts on most, and pressures that answer depths of their shapes.

    The first are spanned by Schur vectors, so they stay well conditioned; the second have the
    peaks at the ends of the face that a disturbance in time has too.

    Parameters
    ----------
    elastic, thermal : ndarray, shape (m, m)
        A, and H at the given speed.
    depths : ndarray, shape (m, m)
        Weak depth per coefficient of a depth in the pressure space.
    space : LoadFree
        All of them; it is the result if there are not more than asked for.
    count : int
        Of either kind.
    """
    matrix = _influence(elastic, thermal, space)
    if len(matrix) <= 2 * count:
        return space
    least = np.sort(np.abs(np.linalg.eigvals(matrix)))[-count] * (1 - 1e-9)
    _, vectors, found = schur(matrix, sort=lambda re, im=0.0: abs(complex(re, im)) >= least)
    strong = vectors[:, :found]
    answers = np.linalg.solve(space(elastic), space(depths) @ strong)
    return space.narrowed(orth(np.hstack([strong, answers / np.linalg.norm(answers, axis=0)])))


def _influence(elastic: np.ndarray, thermal: np.ndarray, space: LoadFree) -> np.ndarray:
    """Pressure that the heat of a pressure leads to."""
    return -np.linalg.solve(space(elastic), space(thermal))


@dataclass(frozen=True)
class Rate:
    """Growth rate of a perturbation.

    Attributes
    ----------
    value : complex
        s, with an imaginary part that is not negative [1/s].
    shape : ndarray, shape (q,)
        Of the pressure, in the space of the disturbances.
    """

    value: complex
    shape: np.ndarray


@dataclass(frozen=True)
class Disturbances:
    """Small dense operators of disturbances in time.

    Attributes
    ----------
    elastic : ndarray, shape (q, q)
        A in the spaces of the disturbances.
    opening : ndarray, shape (q, r)
        B of r thermal coordinates.
    heated : ndarray, shape (r, q)
        Q at the given speed.
    conducted, carried, stored : ndarray, shape (r, r)
        K, C at the given speed, and M.
    """

    elastic: np.ndarray
    opening: np.ndarray
    heated: np.ndarray
    conducted: np.ndarray
    carried: np.ndarray
    stored: np.ndarray

    def fastest(self, factor: float, wear: np.ndarray | None = None) -> Rate:
        """The disturbance that grows fastest, or dies out most slowly.

        Parameters
        ----------
        factor : float
            V.
        wear : ndarray, shape (q, q), optional
            S at that speed.
        """
        matrix, pressure = self._evolution(factor, wear)
        rates, states = np.linalg.eig(matrix)
        best = int(np.argmax(np.where(_changing(rates), rates.real, -np.inf)))
        value, state = complex(rates[best]), states[:, best]
        if value.imag < 0:
            value, state = value.conjugate(), state.conj()
        return Rate(value, pressure @ state)

    def growth(self, factor: float, wear: np.ndarray | None = None) -> float:
        """Largest real part of the rates of what changes [1/s]."""
        rates = np.linalg.eigvals(self._evolution(factor, wear)[0])
        changing = rates[_changing(rates)]
        return float(changing.real.max()) if len(changing) else 0.0

    def onset(
        self, start: float, wear: Callable[[float], np.ndarray] | None = None
    ) -> float | None:
        """Factor of the speed from which on disturbances grow: the first above a start.

        Where they grow there already, the first below it.

        Parameters
        ----------
        start : float
        wear : callable, optional
            S for a factor of the speed.

        Returns
        -------
        float or None
            None where there is none near enough.
        """

        def growth(factor: float) -> float:
            return self.growth(factor, None if wear is None else wear(factor))

        factor, grows = start, growth(start) > 0
        while 1 / _RANGE <= factor / start <= _RANGE:
            following = factor / _STRIDE if grows else factor * _STRIDE
            if (growth(following) > 0) != grows:
                ends = sorted((factor, following))
                return float(brentq(growth, *ends, xtol=1e-11 * ends[1], rtol=1e-11))
            factor = following
        return None

    def _evolution(self, factor: float, wear: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
        """Rate of change of temperatures and worn depths, and the pressure that goes with them."""
        q = len(self.elastic)
        opened = self.opening if wear is None else np.hstack([self.opening, np.eye(q)])
        pressure = -np.linalg.solve(self.elastic, opened)
        flow = factor * self.heated @ pressure
        r = len(self.stored)
        flow[:, :r] -= self.conducted + factor * self.carried
        change = np.linalg.solve(self.stored, flow)
        if wear is not None:
            change = np.vstack([change, wear @ pressure])
        return change, pressure


def _changing(rates: np.ndarray) -> np.ndarray:
    return np.abs(rates) > _ROUNDING * np.abs(rates).max()
