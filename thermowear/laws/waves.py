"""Linear stability of sliding contact against waves: critical speeds and growth rates.

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

from collections.abc import Callable, Sequence
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


_TOLERANCE, _ITERATIONS = 1e-11, 40
_DIFFERENCE = 1e-5
"""Relative step of numerical derivatives of the logarithm of a gain."""
_LARGEST_STEPS = np.array([0.7, 10.0])
"""Largest changes in a step: of the logarithm of a speed factor, of a frequency by its scale."""
_ROUGH, _ROUNDS, _SLOW = 0.02, 40, 1e-4
_RANGE, _PER_DECADE = (-3, 5), 3
"""Decades of the rates that are scanned, relative to that of diffusion over a wave length."""
_BESIDE_OTHERS = (-1, 3), 2
"""Rates in the frames of the other bodies, likewise."""
_TURN = 1.0
"""Largest change of the phase of the determinant between neighbouring samples [rad]."""
_BESIDE, _HARDLY, _FAST = 0.98, 1.1, 1e3
_WEAR_STEPS, _NEAR = 8, 0.1


@dataclass(frozen=True)
class WaveMode:
    """Mode of a wave.

    Attributes
    ----------
    factor : float
        Speed factor.
    rate : complex
        Growth rate and angular frequency in the frame of the reference body [1/s].
    shape : ndarray, shape (q,)
        Complex pressure coefficients.
    """

    factor: float
    rate: complex
    shape: np.ndarray


def first_critical(equations: WaveEquations, guess: float = 1.0) -> WaveMode | None:
    """Slowest critical mode without wear that stands still on one of the bodies, or nearly so.

    None if there is none; `lowest` finds others.

    Parameters
    ----------
    equations : WaveEquations
    guess : float
        Speed factor near it, if known.
    """
    plain, found = equations.without_wear, list[WaveMode]()
    for frame in equations.frames:
        parts = (1.0, _SLOW) if frame == 0.0 else (1.0,)
        starts = (_standing(plain, frame, guess * part) for part in parts)
        found += [mode for mode in [next((one for one in starts if one is not None), None)] if mode]
    return _slowest(found)


def lowest(
    equations: WaveEquations, candidate: WaveMode | None, guess: float = 1.0
) -> tuple[WaveMode | None, bool]:
    """Mode of the lowest critical speed without wear, by the number of growing waves.

    Parameters
    ----------
    equations : WaveEquations
    candidate : WaveMode or None
        Mode below whose critical speed waves may grow.
    guess : float
        Speed factor near it, if there is no candidate.

    Returns
    -------
    mode : WaveMode or None
        None where no wave grows.
    complete : bool
        False if waves grow below its critical speed that were not found.
    """
    plain, mode = equations.without_wear, candidate
    below = _FAST * guess if mode is None else _BESIDE * mode.factor
    while growing(plain, below):
        found = _from_samples(plain, _onset(plain, below))
        if found is None or found.factor >= below:
            return mode, False
        mode, below = found, _BESIDE * found.factor
    return mode, True


def _onset(equations: WaveEquations, above: float) -> float:
    """Speed factor at which a wave grows but hardly, below one at which some grow."""
    low, high = above / 2, above
    while low > above / _FAST and growing(equations, low):
        low, high = low / 2, low
    while high / low > _HARDLY:
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if growing(equations, middle) else (middle, high)
    return high


def with_wear(equations: WaveEquations, mode: WaveMode) -> WaveMode | None:
    """Critical mode with wear that develops from one without; None where it is not found.

    The wear is increased step by step.
    """
    if not equations.worn:
        return mode
    plain, whole = mode, _critical(equations, mode)
    if whole is not None and abs(np.log(whole.factor / mode.factor)) < _NEAR:
        return whole
    for part in np.linspace(0.0, 1.0, _WEAR_STEPS + 1)[1:] ** 2:
        worn = equations.with_wear_times(float(part))
        following = _critical(worn, mode)
        if following is None and mode is plain:
            following = _departing(worn, plain)
        if following is None:
            return None
        mode = following
    return mode


def at_speed(equations: WaveEquations, mode: WaveMode, factor: float) -> WaveMode | None:
    """Mode at another speed that develops from a given one, with its growth rate."""
    steps = max(1, int(np.ceil(abs(np.log(factor / mode.factor)) / 0.1)))
    for part in np.geomspace(mode.factor, factor, steps + 1)[1:]:
        following = _grown(equations, mode, float(part)) or _parted(equations, mode, float(part))
        if following is None:
            return None
        mode = following
    return mode


def _parted(equations: WaveEquations, mode: WaveMode, factor: float) -> WaveMode | None:
    """Fastest of the modes near one that two modes meet at, stationary and swinging ones."""
    size = max(abs(mode.rate), equations.slowest)
    starts = [mode.rate + part * size for part in (0.3j, -0.3j, 0.3, -0.3, 1j, -1j)]
    found = [_grown(equations, replace(mode, rate=rate), factor) for rate in starts]
    grown = [one for one in found if one is not None]
    return max(grown, key=lambda one: one.rate.real) if grown else None


def growing(equations: WaveEquations, factor: float) -> int:
    """Number of growing waves at a speed factor, without wear (criterion of Nyquist).

    The phase of the determinant of `WaveEquations` along the imaginary axis: conduction alone has
    no growing modes, and the determinant tends to 1 for high rates.
    """
    _, values = _sampled(equations, factor)
    turned = np.angle(values[1:] / values[:-1]).sum() + np.angle(values[0] / values[-1])
    return round(float(-turned / (2 * np.pi)))


def _sampled(equations: WaveEquations, factor: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [rad/s], ascending, and determinants, dense where the phase changes quickly."""
    parts = []
    for frame in equations.frames:
        (low, high), density = (_RANGE, _PER_DECADE) if frame == 0.0 else _BESIDE_OTHERS
        sizes = equations.slowest * np.logspace(low, high, (high - low) * density + 1)
        parts += [-factor * frame - sizes, -factor * frame + sizes]
    points = np.unique(np.concatenate(parts))

    def values_at(frequencies):
        return [equations.determinant(factor, 1j * float(f)) for f in frequencies]

    values = np.array(values_at(points))
    for _ in range(12):
        turns = np.abs(np.angle(values[1:] / values[:-1]))
        wide = np.flatnonzero(turns > _TURN)
        if not len(wide):
            break
        between = (points[wide] + points[wide + 1]) / 2
        order = np.argsort(np.concatenate([points, between]), kind="stable")
        points = np.concatenate([points, between])[order]
        values = np.concatenate([values, values_at(between)])[order]
    return points, values


def _from_samples(equations: WaveEquations, factor: float) -> WaveMode | None:
    """Critical mode near a speed factor at which a wave hardly grows."""
    points, values = _sampled(equations, factor)
    for k in np.argsort(np.abs(values))[:5]:
        gains = equations.gains(factor, 1j * points[k])
        one = int(np.argmin(np.abs(gains.values - 1.0)))
        start = WaveMode(factor, 1j * points[k], gains.shapes[:, one])
        found = _critical(equations, start)
        if found is not None and abs(np.log(found.factor / factor)) < 0.2:
            return found
    return None


def _standing(equations: WaveEquations, frame: float, factor: float) -> WaveMode | None:
    """Critical mode that stands still on a body, or nearly so."""
    for _ in range(_ROUNDS):
        gain, shape = equations.gains(factor, -1j * factor * frame).largest
        if gain.real <= 0.0:
            return None
        change = float(np.clip(1.0 / gain.real, 1e-3, 1e3))
        factor *= change
        if abs(change - 1.0) < _ROUGH:
            break
    return _critical(equations, WaveMode(factor, -1j * factor * frame, shape))


def _departing(equations: WaveEquations, mode: WaveMode) -> WaveMode | None:
    """Critical mode with little wear, from one that stands still on a worn body."""
    found = []
    for body in equations.worn:
        for size in np.logspace(-4, 1, 6):
            for sign in (1.0, -1.0):
                rate = 1j * (sign * size * equations.slowest - mode.factor * body.turning)
                one = _critical(equations, WaveMode(mode.factor, rate, mode.shape))
                if one is not None and one.factor > 0.5 * mode.factor:
                    found.append(one)
    return _slowest(found)


def _slowest(modes: Sequence[WaveMode]) -> WaveMode | None:
    """Mode of the lowest speed; None of none."""
    return min(modes, key=lambda mode: mode.factor) if modes else None


def _critical(equations: WaveEquations, start: WaveMode) -> WaveMode | None:
    """Mode of zero growth, by Newton's method for the speed and the frequency."""

    def residual(x: np.ndarray, shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        factor, frequency = float(np.exp(x[0])), x[1] * scale
        gain, shape = equations.gains(factor, 1j * frequency).like(shape)
        value = np.log(gain)
        return np.array([value.real, value.imag]), shape

    scale = max(equations.slowest, abs(start.rate.imag))
    x = np.array([np.log(start.factor), start.rate.imag / scale])
    found = _newton(residual, x, start.shape)
    if found is None:
        return None
    x, shape = found
    return WaveMode(float(np.exp(x[0])), 1j * float(x[1] * scale), shape)


def _grown(equations: WaveEquations, start: WaveMode, factor: float) -> WaveMode | None:
    """Mode at a speed factor, by Newton's method for its rate."""

    def residual(x: np.ndarray, shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        gain, shape = equations.gains(factor, complex(*x) * scale).like(shape)
        value = np.log(gain)
        return np.array([value.real, value.imag]), shape

    scale = max(equations.slowest, abs(start.rate))
    x = np.array([start.rate.real, start.rate.imag]) / scale
    found = _newton(residual, x, start.shape)
    if found is None:
        return None
    x, shape = found
    return WaveMode(factor, complex(*x) * scale, shape)


def _newton(
    residual: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]],
    x: np.ndarray,
    shape: np.ndarray,
) -> tuple[np.ndarray, np.ndarray] | None:
    """Zero of a residual of two unknowns, whose derivatives are updated by Broyden's formula."""
    value, shape = residual(x, shape)
    columns = []
    for axis in np.eye(2):
        columns.append((residual(x + _DIFFERENCE * axis, shape)[0] - value) / _DIFFERENCE)
    slopes = np.stack(columns, axis=1)
    for _ in range(_ITERATIONS):
        if np.abs(value).max() < _TOLERANCE:
            return x, shape
        if not np.isfinite(slopes).all() or abs(np.linalg.det(slopes)) < 1e-300:
            return None
        step = -np.linalg.solve(slopes, value)
        step *= min(1.0, (_LARGEST_STEPS / np.maximum(np.abs(step), 1e-300)).min())
        x = x + step
        following, shape = residual(x, shape)
        if not np.isfinite(following).all():
            return None
        slopes += np.outer(following - value - slopes @ step, step) / (step @ step)
        value = following
    return (x, shape) if np.abs(value).max() < 1e-8 else None
