"""Primal-dual interior-point method for steady pressures, and the rates that it needs.

Find a pressure p and multipliers V (rigid-body wear velocities) with::

    p >= 0,   s = h(p) + N S - R V >= 0,   p s = 0        h(p) = Σ_i h_i(p)
    Tᵀ w p = F,   S_k = Σ_points a_k h_k(p)

where s is the separation rate of the faces, S the means of wear distributed over a track, and N
their weights at every point. For ``T = R`` and S = 0 these are the conditions of a convex minimum;
friction (``T ≠ R``) makes them unsymmetric. p and s are independent unknowns and stay positive
during the iteration, which keeps the accuracy for exponents far from 1 and points at the edge of
contact: Mehrotra's predictor-corrector method (SIAM J. Optim. 2 (1992) 575; Nocedal and Wright,
Numerical Optimization, 2006, section 14.2), with Newton steps on all conditions, damped to keep
them positive, from uniform pressure.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ...errors import ComputationError
from ..interfaces import Law, LocalState

_MULTIPLES = np.array([0.03, 0.1, 0.3, 0.6, 1.0, 1.5, 3.0, 10.0])
"""Multiples of the steady pressure between which a rate must not decrease."""
_ROUNDING = 1e-9


class RateSum(ABC):
    """Sum of rates that increase with the pressure at each point."""

    @abstractmethod
    def terms(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Summands and their derivatives at positive pressures, shape (m, n) each."""

    @abstractmethod
    def scaled(self, pressure: np.ndarray, value: float) -> RateSum:
        """Sum scaled by a pressure at each point and by a value."""

    def at(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Value and derivative at positive pressures, shape (n,) each."""
        terms, slopes = self.terms(pressure)
        return terms.sum(axis=0), slopes.sum(axis=0)


@dataclass(frozen=True)
class PowerSum(RateSum):
    """Pointwise sum of powers ``Σ_i g_i p^e_i``.

    Attributes
    ----------
    factors : ndarray, shape (m, n)
    exponents : ndarray, shape (m,) or (m, n)
    """

    factors: np.ndarray
    exponents: np.ndarray

    def terms(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        exponents = np.atleast_2d(self.exponents.T).T
        terms = self.factors * pressure**exponents
        return terms, exponents * terms / pressure

    def scaled(self, pressure: np.ndarray, value: float) -> PowerSum:
        return PowerSum(self.terms(pressure)[0] / value, self.exponents)


@dataclass(frozen=True)
class BoundLaw:
    """Wear law at the contact points, as a function of the pressure only.

    Attributes
    ----------
    law : Law
    state : LocalState
        State of the points; its pressure is not used.
    """

    law: Law
    state: LocalState

    def rate(self, pressure: np.ndarray) -> np.ndarray:
        """Local wear rate (n,) [m/s]."""
        return self.law.value(self.state._replace(p=pressure))

    def slope(self, pressure: np.ndarray) -> np.ndarray:
        """Derivative with respect to the pressure (n,) [m/(s Pa)]."""
        return self.law.slope(self.state._replace(p=pressure))

    def require_growth(self, pressure: np.ndarray) -> None:
        """Reject a law whose rate decreases with pressure, around given pressures.

        Raises
        ------
        ComputationError
            If the rate decreases with pressure.
        """
        rates = np.array([self.rate(factor * pressure) for factor in _MULTIPLES])
        if np.any(np.diff(rates, axis=0) < -_ROUNDING * rates[:-1]):
            raise ComputationError(
                "no steady state: a wear rate decreases with increasing pressure; the steady "
                "principle requires wear rates that increase with it"
            )


@dataclass(frozen=True)
class LawSum(RateSum):
    """Weighted rates of several laws, in units of a pressure at each point.

    Attributes
    ----------
    laws : sequence of BoundLaw
        Law of each summand.
    weights : ndarray, shape (m, n)
    pressure : ndarray, shape (n,)
        Unit of the pressures [Pa].
    """

    laws: Sequence[BoundLaw]
    weights: np.ndarray
    pressure: np.ndarray

    def terms(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        p, shape = self.pressure * pressure, self.weights.shape
        rates = np.reshape([law.rate(p) for law in self.laws], shape)
        slopes = np.reshape([law.slope(p) for law in self.laws], shape)
        return self.weights * rates, self.weights * self.pressure * slopes

    def scaled(self, pressure: np.ndarray, value: float) -> LawSum:
        return LawSum(self.laws, self.weights / value, self.pressure * pressure)


@dataclass(frozen=True)
class Common:
    """Means of rates shared by several points.

    Attributes
    ----------
    rates : RateSum
        Rates of which the means are formed, one summand each.
    rows : sequence of sparse array, shape (K_i, n)
        Weights of the points in the means of each rate; K is the number of all means.
    reach : ndarray, shape (n, K)
        Weights N of each mean at each point.
    """

    rates: RateSum
    rows: Sequence[sp.csr_array]
    reach: np.ndarray

    @classmethod
    def none(cls, n: int) -> Common:
        """Empty set of means at n points."""
        return cls(PowerSum(np.zeros((0, n)), np.zeros(0)), [], np.zeros((n, 0)))

    def at(self, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray | sp.csr_array]:
        """Means (K,), and their derivatives at positive pressures, shape (K, n)."""
        if not self.rows:
            return np.zeros(0), self.reach.T
        rates, slopes = self.rates.terms(pressure)
        means = [rows @ rate for rows, rate in zip(self.rows, rates, strict=True)]
        changes = [rows * slope for rows, slope in zip(self.rows, slopes, strict=True)]
        return np.concatenate(means), sp.csr_array(sp.vstack(changes))

    def scaled(self, pressure: np.ndarray, value: float) -> Common:
        """Means scaled by a pressure at each point and by a value."""
        return Common(self.rates.scaled(pressure, value), self.rows, self.reach)


STEPS = 200
FLOOR = 1e-2  # relative starting pressure of points that separate without friction
TO_THE_BOUNDARY = 0.9995  # fraction of the step to the boundary of positive p and s
CENTRED, SHORT = 0.3, 0.1  # target of p s relative to its mean; smallest useful step length
GROWTH = 10.0  # largest growth of rates in a step: large exponents would overshoot
VANISHED = 1e-60  # sum of p s below which an unconverged iteration has no solution
EXACT, ENOUGH = 1e-13, 1e-10  # relative errors: target, and largest accepted one
AT_REST = 1e-12  # pressure and wear velocity, relative to the largest, that count as zero


@dataclass(frozen=True)
class Solution:
    """Solution of the interior-point method.

    Attributes
    ----------
    pressure : ndarray, shape (n,)
    velocity : ndarray, shape (k,)
        Velocity V.
    regular : bool
        True if wear increases with the load: positive determinant, as without friction.
    """

    pressure: np.ndarray
    velocity: np.ndarray
    regular: bool


def solve(
    weights: np.ndarray,
    normal_modes: np.ndarray,
    force_modes: np.ndarray,
    load: np.ndarray,
    local: RateSum,
    common: Common | None = None,
) -> Solution | None:
    """Solve for pressure and multipliers; None if the method finds no solution.

    Parameters
    ----------
    weights : ndarray, shape (n,)
        Areas; a point without area is a probe, solved for without load contribution.
    normal_modes, force_modes : ndarray, shape (n, k)
        R and T; the columns of R are independent.
    load : ndarray, shape (k,)
        Load F; no solution if it is zero.
    local : RateSum
        Local rate h.
    common : Common, optional
        Means S and weights N.
    """
    share = weights / weights.sum()
    # motions orthonormal over the face: independent of pivots and units of rotations
    _, triangle = np.linalg.qr(np.sqrt(share)[:, None] * normal_modes)
    basis = np.linalg.inv(triangle)
    conditions = _Conditions(
        normal_modes @ basis,
        share[:, None] * (force_modes @ basis),
        basis.T @ load / weights.sum(),
        local,
        common or Common.none(len(weights)),
    )
    force = np.linalg.norm(conditions.load)
    if force == 0:
        return None
    found = _solve_from(conditions, np.full(len(weights), force))
    if found is None or not found.regular:
        bare = replace(conditions, force_modes=share[:, None] * conditions.normal_modes)
        without = _solve_from(bare, np.full(len(weights), force))
        if without is not None:  # near self-locking: convergence from few starts only
            start = np.maximum(without.pressure, FLOOR * without.pressure.max())
            start *= force / np.linalg.norm(conditions.force_modes.T @ start)
            found = _solve_from(conditions, start) or found
    return found and replace(found, velocity=basis @ found.velocity)


@dataclass(frozen=True)
class _Conditions:
    """Data of the problem as in `solve`; areas of sum 1 are included in the force modes."""

    normal_modes: np.ndarray
    force_modes: np.ndarray
    load: np.ndarray
    local: RateSum
    common: Common

    def scaled(self, pressure: np.ndarray, rate: float) -> _Conditions:
        """Problem scaled by a pressure at each point and by a rate."""
        return _Conditions(
            self.normal_modes,
            pressure[:, None] * self.force_modes / np.linalg.norm(self.load),
            self.load / np.linalg.norm(self.load),
            self.local.scaled(pressure, rate),
            self.common.scaled(pressure, rate),
        )

    def rate(self, multipliers: np.ndarray) -> np.ndarray:
        """Rate ``R V - N S`` at the points, from the multipliers ``(V, S)``."""
        k = len(self.load)
        return self.normal_modes @ multipliers[:k] - self.common.reach @ multipliers[k:]


class _Linearised:
    """Linearised conditions at positive pressures and separation rates."""

    def __init__(self, conditions: _Conditions, pressure, separation, multipliers):
        worn, slope = conditions.local.at(pressure)
        passed, passed_slope = conditions.common.at(pressure)
        rate = conditions.rate(multipliers)
        self.loads = k = len(conditions.load)
        self.pressure, self.separation = pressure, separation
        self.worn = worn
        self.residual = worn - rate - separation
        self.balance = np.append(
            conditions.force_modes.T @ pressure - conditions.load, multipliers[k:] - passed
        )
        self.modes = np.column_stack([conditions.normal_modes, -conditions.common.reach])
        self.force_modes, self.passed_slope = conditions.force_modes, passed_slope
        self.compliance = 1 / (slope + separation / pressure)
        self.tangent = self.forces(self.compliance[:, None] * self.modes)
        self.tangent[k:, k:] += np.eye(len(passed))
        self.rate_scale = np.abs(rate).max()

    def forces(self, pressures: np.ndarray) -> np.ndarray:
        """Loads and changes of the means by pressures (n, ...), shape (k + K, ...)."""
        return np.concatenate([self.force_modes.T @ pressures, -(self.passed_slope @ pressures)])

    def error(self) -> float:
        """Largest violation of any condition, relative."""
        apart = np.minimum(self.pressure / self.pressure.max(), self.separation / self.rate_scale)
        k = self.loads
        rates = np.abs(np.append(self.residual, self.balance[k:])) / self.rate_scale
        return float(np.max([np.abs(self.balance[:k]).max(), rates.max(), apart.max()]))

    def step(self, product: np.ndarray):
        """Newton step of (V, S), p and s for a change of the products p s by `product`."""
        drive = product / self.pressure - self.residual
        right = -self.balance - self.forces(self.compliance * drive)
        multipliers = np.linalg.lstsq(self.tangent, right, rcond=None)[0]
        pressure = self.compliance * (self.modes @ multipliers + drive)
        separation = (product - self.separation * pressure) / self.pressure
        return multipliers, pressure, separation


def _solve_from(conditions: _Conditions, start: np.ndarray) -> Solution | None:
    """Solution from a positive initial pressure, for the motions of the conditions."""
    worn = conditions.local.at(start)[0]
    common = conditions.common.reach @ conditions.common.at(start)[0]
    unit = float((worn + common).mean())
    if unit == 0.0:
        raise ComputationError(
            "no unique steady state: the wear rate at the mean pressure is 0 (below the threshold "
            "of the wear law); increase the load or the speed"
        )
    found = _iterate(conditions.scaled(start, unit))
    if found is None:
        return None
    pressure, multipliers, regular = found
    return Solution(start * pressure, unit * multipliers[: len(conditions.load)], regular)


@np.errstate(all="ignore")  # without a solution the numbers overflow
def _iterate(conditions: _Conditions) -> tuple[np.ndarray, np.ndarray, bool] | None:
    """Iterate from pressure 1; pressure, multipliers ``(V, S)`` and regularity."""
    pressure = np.ones(len(conditions.normal_modes))
    multipliers = np.append(conditions.load, np.zeros(conditions.common.reach.shape[1]))
    separation = conditions.local.at(pressure)[0] - conditions.rate(multipliers)
    separation = np.maximum(separation, 1.0)
    for _ in range(STEPS):
        newton = _Linearised(conditions, pressure, separation, multipliers)
        error = newton.error()
        diverged = not pressure @ separation > VANISHED or not np.isfinite(
            error + newton.tangent.sum()
        )
        if error < EXACT or diverged:
            break
        d, dp, ds = _predicted_and_corrected(newton)
        reach = _step_length((pressure, dp), (separation, ds))
        most = GROWTH * max(newton.worn.max(), newton.rate_scale)
        while conditions.local.at(pressure + reach * dp)[0].max() > most:
            reach /= 2
        multipliers = multipliers + reach * d
        pressure = pressure + reach * dp
        separation = separation + reach * ds
    if not error < ENOUGH:
        return None
    approach = conditions.normal_modes @ multipliers[: len(conditions.load)]
    pressing = pressure / pressure.max()
    touching = pressing > separation / newton.rate_scale
    # where nothing approaches, as between fixed bodies, both p and s are rounding
    touching &= (pressing > AT_REST) | (approach > AT_REST * np.abs(approach).max())
    touching &= conditions.normal_modes.any(axis=1)
    return np.where(touching, pressure, 0.0), multipliers, bool(np.linalg.det(newton.tangent) > 0)


def _predicted_and_corrected(newton: _Linearised):
    """Predictor-corrector step, with the second-order term of ``p s``.

    The common target of the products p s is chosen from a predictor step to zero, but not so small
    that they vanish before the rates are in balance.
    """
    pressure, separation = newton.pressure, newton.separation
    product = pressure * separation
    mean = np.mean(product)
    _, dp, ds = newton.step(-product)
    reach = _step_length((pressure, dp), (separation, ds))
    predicted = np.mean((pressure + reach * dp) * (separation + reach * ds))
    mean_residual = np.mean(pressure * np.abs(newton.residual))
    centre = max((predicted / mean) ** 3 * mean, min(CENTRED * mean, mean_residual / 10))
    step = newton.step(centre - product - dp * ds)
    if _step_length((pressure, step[1]), (separation, step[2])) < SHORT:
        step = newton.step(CENTRED * mean - product)  # the corrector is not useful
    return step


def _step_length(*positive: tuple[np.ndarray, np.ndarray]) -> float:
    """Largest fraction of a step that keeps all values positive."""
    falls = [(-step[step < 0] / value[step < 0]).max(initial=0.0) for value, step in positive]
    return min(1.0, TO_THE_BOUNDARY / max(*falls, 1e-300))
