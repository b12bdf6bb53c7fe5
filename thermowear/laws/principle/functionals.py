"""Three candidate functionals for a minimum principle of steady wear, for any q.

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
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..power_wear import PowerWear


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
