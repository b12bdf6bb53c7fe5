"""Minimisation of candidate functionals over the pressures in equilibrium.

With the normal wear rates ``w'_i = Z_i p^b_i`` and the friction factor
``c = 1 + mu e_1·e_R/(n·e_R)`` (``1 ∓ mu tan χ`` in Páczelt and Mróz) of ``p·w'_i = c p w'_i``::

    W^(q)   = Σ_i (∫ (Z_i p^b_i)^q dS)^(1/q)            generalised wear volume rate
    D_F^(q) = (∫ (mu p v)^q dS)^(1/q)                   generalised friction dissipation power
    D_w^(q) = Σ_i (∫ (c Z_i p^(b_i+1))^q dS)^(1/q)      generalised wear dissipation power

Each is a sum of ``‖g_i p^m_i‖_q`` with degrees m = b, 1 and b + 1, i.e. of powers m of norms of p
with exponent m q. Their minimum under equilibrium is

* unique if ``m_i q > 1`` for each body, and there is one body, or both have the same m and
  proportional g, or both have ``m_i >= 1``: always for D_w with ``q > 1/(b + 1)``, for D_F with
  ``q > 1``, and for W of one body with ``q > 1/b``;
* for W of two bodies with b < 1 and different a, or different b, attained, but possibly not
  unique (`minimum.minimise` returns the lowest found);
* not attained if ``m_i q <= 1``: the infimum is approached by pressures concentrated in points, and
  for ``m q = 1`` many may be equal (``D_F^(1)`` of a translation is mu v F for any pressure).

Only D_w with q = 1 has the steady state as its minimum for any a and b.

Stationarity of ``Σ_i (∫ (g_i p^m_i)^q dS)^(1/q)`` under ``Tᵀ w p = F`` reads::

    Σ_i m_i κ_i g_i^q p^(m_i q - 1) = T Λ,        κ_i = (∫ (g_i p^m_i)^q dS)^(1/q - 1)

for ``D_w^(q)`` the pressure of Páczelt and Mróz,
``p = [TΛ c^-q / Σ Z_i^q C_i^((1-q)/q)]^(1/((b+1)q-1))``, up to multiples of κ and Λ. For given κ
the problem is convex, of the same form as the steady state; for one body κ is a common factor, for
two bodies their ratio is a scalar unknown.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy

from ...errors import ComputationError
from ..wear import PowerWear
from .interior_point import PowerSum, solve
from .steady import not_carried, steady_pressure


@dataclass(frozen=True)
class PowerFunctional:
    """Functional ``Σ_i (∫ (g_i p^m_i)^q dS)^(1/q)``.

    Attributes
    ----------
    weights : ndarray, shape (n,) [m²]
    factors : ndarray, shape (m, n)
        Factor g of each body, positive.
    degrees : ndarray, shape (m,)
        Degree m of each body.
    q : float
        Control parameter, positive.
    """

    weights: np.ndarray
    factors: np.ndarray
    degrees: np.ndarray
    q: float

    @property
    def defined(self) -> bool:
        """True if there is a minimum: ``m q > 1``."""
        return bool(np.all(self.degrees * self.q > 1))

    def parts(self, pressure: np.ndarray) -> np.ndarray:
        """Summand of each body, shape (..., m), for pressures of shape (..., n)."""
        density = self.factors * pressure[..., None, :] ** self.degrees[:, None]
        largest = density.max(axis=-1, keepdims=True)
        largest = np.where(largest > 0, largest, 1.0)  # scaling keeps powers of large q in range
        total = (density / largest) ** self.q @ self.weights
        return largest[..., 0] * total ** (1 / self.q)

    def __call__(self, pressure: np.ndarray) -> np.ndarray:
        """Value at pressures of shape (..., n) [Pa]."""
        return self.parts(pressure).sum(axis=-1)

    def gradient(self, pressure: np.ndarray) -> np.ndarray:
        """Derivative by the pressure, per area: ``Σ m_i J_i^(1-q) (g_i p^m_i)^q / p``.

        Shape (n,), at positive pressures.
        """
        density = self.factors * pressure ** self.degrees[:, None]
        parts = self.parts(pressure)[:, None]
        terms = self.degrees[:, None] * density * (density / parts) ** (self.q - 1)
        return terms.sum(axis=0) / pressure


def wear_dissipation(
    weights: np.ndarray,
    laws: Sequence[PowerWear],
    speed: np.ndarray,
    q: float = 1.0,
    inclination_factor: np.ndarray | float = 1.0,
) -> PowerFunctional:
    """Wear dissipation ``D_w^(q)``, with c for given wear-velocity directions."""
    factors = np.array([inclination_factor * law.factor(speed) for law in laws])
    degrees = np.array([law.pressure_exponent + 1 for law in laws])
    return PowerFunctional(weights, factors, degrees, q)


def friction_dissipation(
    weights: np.ndarray, friction: float, speed: np.ndarray, q: float
) -> PowerFunctional:
    """Friction dissipation ``D_F^(q)``."""
    return PowerFunctional(weights, (friction * speed)[None, :], np.ones(1), q)


def wear_volume_rate(
    weights: np.ndarray, laws: Sequence[PowerWear], speed: np.ndarray, q: float
) -> PowerFunctional:
    """Wear volume rate ``W^(q)``; for q = 1 in [m³/s]."""
    factors = np.array([law.factor(speed) for law in laws])
    degrees = np.array([law.pressure_exponent for law in laws])
    return PowerFunctional(weights, factors, degrees, q)


def admissible_changes(
    rng: np.random.Generator,
    count: int,
    weights: np.ndarray,
    force_modes: np.ndarray,
    pressure: np.ndarray,
    sizes: tuple[float, float] = (1e-3, 1.0),
) -> np.ndarray:
    """Random changes of a pressure without resultants and without tension.

    Positive pressures increase or decrease, zero pressures only increase; multiples ``p T c`` of
    the pressure then cancel the resultants.

    Parameters
    ----------
    rng : numpy.random.Generator
    count : int
        Number m of changes.
    weights, force_modes, pressure
        w, T, p at n points; the pressed points can balance any load on T.
    sizes : tuple of float
        Bounds of the maximum relative change, drawn log-uniformly.

    Returns
    -------
    ndarray, shape (m, n) [Pa]
        Changes δ with ``Tᵀ w δ = 0`` and ``p + δ >= 0``.
    """
    noise = rng.standard_normal((count, len(pressure)))
    raised = np.abs(noise) * (weights @ pressure / weights.sum()) * rng.random((count, 1)) ** 2
    change = np.where(pressure > 0, noise * pressure, raised)
    weighted = weights[:, None] * force_modes
    resultants = change @ weighted
    gram = force_modes.T @ (pressure[:, None] * weighted)
    change -= pressure * (np.linalg.solve(gram, resultants.T).T @ force_modes.T)
    relative = np.max(
        np.abs(np.divide(change, pressure, out=np.zeros_like(change), where=pressure > 0)), axis=1
    )
    low, high = np.log(sizes)
    size = np.exp(rng.uniform(low, high, count))
    return change * (size / relative)[:, None]


_SEARCH = 16  # number of search intervals for the ratio of κ
_TOLERANCE, _ACCEPTED = 1e-13, 1e-9  # of the direction: target, and largest accepted error
_MOST_EVALUATIONS = 120  # of the direction, each a minimisation


@dataclass(frozen=True)
class Minimum:
    """Minimiser of a functional.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    multipliers : ndarray, shape (k,)
        Λ, derivative of the minimum with respect to the load.
    value : float
    """

    pressure: np.ndarray
    multipliers: np.ndarray
    value: float


def minimise(functional: PowerFunctional, force_modes: np.ndarray, load: np.ndarray) -> Minimum:
    """Minimise a functional over pressures ``p >= 0`` with ``Tᵀ w p = F``.

    Parameters
    ----------
    functional : PowerFunctional
    force_modes : ndarray, shape (n, k)
        Force modes T.
    load : ndarray, shape (k,)
        Load F.

    Raises
    ------
    NotCarried
        If no pressure carries the load.
    ComputationError
        If the functional has no minimum for its q.
    """
    if not functional.defined:
        raise ComputationError(
            f"no minimum: q = {functional.q:g} must exceed "
            f"{1 / functional.degrees.min():g} for this functional"
        )
    scale = np.abs(force_modes).max(axis=0)
    unit = np.linalg.norm(load / scale) / functional.weights.sum()
    factors = functional.factors * unit ** functional.degrees[:, None]
    scaled = replace(functional, factors=factors / factors.max())
    parts = [
        _at_ratio(scaled, force_modes, load / unit, ratio)
        for ratio in _stationary_ratios(scaled, force_modes, load / unit)
    ]
    pressure = unit * min(parts, key=lambda p: float(scaled(p)))
    return Minimum(
        pressure, _multipliers(functional, force_modes, pressure), float(functional(pressure))
    )


def least_wear_dissipation(
    weights: np.ndarray,
    normal_modes: np.ndarray,
    force_modes: np.ndarray,
    load: np.ndarray,
    laws: Sequence[PowerWear],
    speed: np.ndarray,
    q: float = 1.0,
) -> Minimum:
    """Minimise ``D_w^(q)``, with the inclination χ of the wear velocity of the minimum itself.

    The multipliers are proportional to the rigid-body wear velocity, so that ``c = TΛ/RΛ``; points
    without positive c have zero pressure. With one motion ``c = T/R``, without friction c = 1;
    otherwise the direction of Λ is a fixed point, iterated from that of the steady state. For q = 1
    and equal b of both bodies the minimum is the steady state.

    Parameters
    ----------
    weights, normal_modes, force_modes, load, laws, speed
        As in `steady.steady_pressure`.
    q : float

    Raises
    ------
    ComputationError
        As in `steady.steady_pressure` and `minimise`, or if no direction is found.
    """
    scale = np.abs(normal_modes).max(axis=0)

    def minimum_for(direction: np.ndarray) -> Minimum:
        opposed, approach = force_modes @ (direction / scale), normal_modes @ (direction / scale)
        pressed = (opposed > 0) & (approach > 0)
        factor = opposed[pressed] / approach[pressed]
        there = wear_dissipation(weights[pressed], laws, speed[pressed], q, factor)
        found = minimise(there, force_modes[pressed], load)
        pressure = np.zeros(len(weights))
        pressure[pressed] = found.pressure
        return replace(found, pressure=pressure)

    def residual(direction: np.ndarray) -> np.ndarray:
        length = np.linalg.norm(direction)
        own = scale * minimum_for(direction).multipliers
        return own / np.linalg.norm(own) - direction / length + (length - 1) * direction

    steady = steady_pressure(weights, normal_modes, force_modes, load, laws, speed)
    start = scale * steady.velocity
    direction = scipy.optimize.root(
        residual,
        start / np.linalg.norm(start),
        options={"xtol": _TOLERANCE, "maxfev": _MOST_EVALUATIONS},
    ).x
    if not np.linalg.norm(residual(direction)) < _ACCEPTED:
        raise ComputationError(
            "no minimum found: the iteration for the direction of the rigid-body wear velocity "
            "did not converge"
        )
    return minimum_for(direction)


def _at_ratio(functional: PowerFunctional, force_modes, load, ratio: float) -> np.ndarray:
    """Stationary pressure for a given logarithm of the ratio of the summands of both bodies."""
    q, degrees = functional.q, functional.degrees
    κ = np.exp((1 - q) * ratio * np.arange(len(degrees)))
    stress = PowerSum((degrees * κ)[:, None] * functional.factors**q, degrees * q - 1)
    found = solve(functional.weights, force_modes, force_modes, load, stress)
    if found is None:
        outside = not_carried(functional.weights, force_modes, load)
        raise outside or ComputationError(f"no minimum found for q = {q:g}")
    return found.pressure


def _stationary_ratios(functional: PowerFunctional, force_modes, load) -> list[float]:
    """Logarithms of the ratio of the summands that are consistent with their pressure."""
    if len(functional.degrees) == 1 or functional.q == 1:
        return [0.0]

    def excess(ratio: float) -> float:
        first, second = functional.parts(_at_ratio(functional, force_modes, load, ratio))
        return float(np.log(second / first)) - ratio

    middle, half = excess(0.0), 1.0
    while excess(middle - half) < 0 or excess(middle + half) > 0:
        half *= 2
    convex = functional.degrees.min() >= 1
    places = np.linspace(middle - half, middle + half, 2 if convex else _SEARCH)
    values = [excess(place) for place in places]
    return [
        scipy.optimize.brentq(excess, *ends, xtol=_TOLERANCE)
        for ends, (low, high) in zip(pairwise(places), pairwise(values), strict=True)
        if low >= 0 >= high or low <= 0 <= high
    ]


def _multipliers(functional: PowerFunctional, force_modes, pressure: np.ndarray) -> np.ndarray:
    """Multipliers Λ from ``dJ/dp = T Λ`` at points with positive pressure."""
    pressed = pressure > 0
    there = replace(
        functional,
        weights=functional.weights[pressed],
        factors=functional.factors[:, pressed],
    )
    return np.linalg.lstsq(force_modes[pressed], there.gradient(pressure[pressed]), rcond=None)[0]
