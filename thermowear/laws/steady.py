"""The steady state of wear from the principle of minimum wear dissipation power (q = 1).

Stationarity of ``D_w = ∫ p Σ w'_i dS`` under equilibrium gives ``Σ Z_i p^b_i = V·n``: the normal
wear rate equals the normal component of the rigid-body wear velocity, and ``p = 0`` where that is
negative (Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895). Friction enters through
equilibrium only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import ComputationError
from .wear import WearLaw


@dataclass(frozen=True)
class SteadyWear:
    """The steady state of wear at the contact points.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    rates : tuple of ndarray, shape (n,)
        Normal wear rate of each wearing body [m/s].
    velocity : ndarray, shape (k,)
        Rigid-body wear velocity along each free direction [m/s or rad/s].
    dissipation : float
        Wear dissipation power D_w [W].
    """

    pressure: np.ndarray
    rates: tuple[np.ndarray, ...]
    velocity: np.ndarray
    dissipation: float


def steady_pressure(
    weights: np.ndarray,
    normal_modes: np.ndarray,
    force_modes: np.ndarray,
    load: np.ndarray,
    laws: list[WearLaw],
    speed: np.ndarray,
) -> SteadyWear:
    """Solve the principle for pressure and rigid-body wear velocity.

    Parameters
    ----------
    weights : ndarray, shape (n,)
        Areas of the contact points [m²].
    normal_modes : ndarray, shape (n, k)
        Normal component of each unit rigid motion at the points.
    force_modes : ndarray, shape (n, k)
        The same for ``n ± mu e_1``, which carries the pressure and its friction in equilibrium.
    load : ndarray, shape (k,)
        Force or moment along each free direction [N or N m].
    laws : list of WearLaw
        Of the wearing bodies, one or two.
    speed : ndarray, shape (n,)
        Sliding speed [m/s].

    Returns
    -------
    SteadyWear

    Raises
    ------
    ComputationError
        If points do not slide, or no admissible pressure carries the load.
    """
    if not np.all(speed > 0):
        raise ComputationError("no steady state: some contact points do not slide")
    factors = [law.factor(speed) for law in laws]
    exponents = [law.pressure_exponent for law in laws]
    weighted = force_modes * weights[:, None]

    def imbalance(velocity):
        pressure, slope = _pressure_at(normal_modes @ velocity, factors, exponents)
        return (weighted.T @ pressure - load) / scale, weighted.T @ (slope[:, None] * normal_modes)

    scale = np.maximum(np.abs(load), 1e-3 * np.abs(load).max())
    mean = np.linalg.lstsq(weighted.T, load, rcond=None)[0]
    mean = np.full(len(weights), max(float(np.average(mean, weights=weights)), 0.0))
    uniform = sum(z * mean**b for z, b in zip(factors, exponents, strict=True))
    velocity = np.linalg.lstsq(normal_modes, uniform, rcond=None)[0]
    velocity = _newton(imbalance, velocity, scale)
    pressure, _ = _pressure_at(normal_modes @ velocity, factors, exponents)
    rates = tuple(law.rate(pressure, speed) for law in laws)
    dissipation = float(weights @ (pressure * (force_modes @ velocity)))
    return SteadyWear(pressure, rates, velocity, dissipation)


def _pressure_at(rate: np.ndarray, factors, exponents) -> tuple[np.ndarray, np.ndarray]:
    """Invert ``Σ Z_i p^b_i = rate`` point by point; pressure and its derivative by the rate.

    In the logarithms of pressure and rate the sum is convex and rises with slopes between the
    smallest and largest b, so Newton's method converges from any start.
    """
    pressure, slope = np.zeros_like(rate), np.zeros_like(rate)
    pressing = rate > 0
    goal = np.log(rate[pressing])
    logs = [np.log(z[pressing]) for z in factors]
    x = np.min([(goal - z) / b for z, b in zip(logs, exponents, strict=True)], axis=0)
    for _ in range(100):
        terms = np.array([z + b * x for z, b in zip(logs, exponents, strict=True)])
        total = np.logaddexp.reduce(terms, axis=0)
        steepness = np.einsum("i,in->n", exponents, np.exp(terms - total))
        step = (goal - total) / steepness
        x += step
        if np.all(np.abs(step) < 1e-14 * np.maximum(np.abs(x), 1.0)):
            break
    pressure[pressing] = np.exp(x)
    slope[pressing] = np.exp(x - goal) / steepness
    return pressure, slope


def _newton(imbalance, velocity: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Damped Newton iteration on the rigid-body wear velocity."""
    residual, jacobian = imbalance(velocity)
    for _ in range(200):
        norm = np.linalg.norm(residual)
        if norm < 1e-13:
            return velocity
        step = np.linalg.lstsq(jacobian / scale[:, None], -residual, rcond=None)[0]
        for damping in 0.5 ** np.arange(40):
            trial, trial_jacobian = imbalance(velocity + damping * step)
            if np.linalg.norm(trial) < (1 - 1e-4 * damping) * norm:
                break
        else:
            if norm < 1e-10:
                return velocity
            break
        velocity = velocity + damping * step
        residual, jacobian = trial, trial_jacobian
    raise ComputationError(
        "no steady state: no rigid-body wear velocity carries the load "
        f"(relative imbalance {np.linalg.norm(residual):.1e})"
    )
