"""Newton's method for contact with wear in an implicit step.

The depth worn in the step is that of the pressure at its end. It is linearised in the pressure, so
that each iteration is a contact problem with an additional compliance. An iterate is damped by half
if the error of its linearisation has not decreased.

The pressure and the other conditions are those at the end of the step; under them every point
passes through its layers as `laws.wear` describes. The depth is a continuous and
increasing function of the pressure with kinks where a border is just reached, for which
`newton_with_wear` uses the derivative on one of both sides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np

from ...errors import ComputationError
from ...laws.distribution import Distribution
from ...laws.interfaces import Law, LocalState
from ...laws.wear import LayerPassage, layers_of

_STEPS = 40
_TOLERANCE = 1e-11
_FAILED = "contact: Newton's method for the implicit step of wear did not converge"


Solution = TypeVar("Solution", bound=Any)
"""Solution of a contact problem, with its `pressure`, or coefficients of it [Pa]."""


class PressureDependentWear(Protocol):
    """Wear as a function of the pressure at the end of a step: depths, or rates.

    It may also depend on the last contact solution, which is not linearised.
    """

    def value(self, pressure: np.ndarray, last: Any) -> np.ndarray:
        """Worn depth [m], or wear rate [m/s]."""

    def slope(self, pressure: np.ndarray, last: Any) -> Any:
        """Derivative of the value, a linear map ``slope @ pressure``."""


@dataclass(frozen=True)
class Slope:
    """Derivative of a gap by the pressures, ``diag(point) + reach rows``.

    Attributes
    ----------
    point : ndarray, shape (n,)
        Derivative by the pressure at the same point; of any shape without means [m/Pa].
    rows : ndarray, shape (k, n)
        Derivatives of k means by the pressures at the points [m/Pa].
    reach : ndarray, shape (n, k)
        Weight of each mean at each point.
    """

    point: np.ndarray
    rows: np.ndarray
    reach: np.ndarray

    @classmethod
    def diagonal(cls, point: np.ndarray) -> Slope:
        """Diagonal derivative, without means."""
        return cls(point, np.zeros((0, len(point))), np.zeros((len(point), 0)))

    def with_compliance(self, point: np.ndarray) -> Slope:
        """Derivative with an additional local compliance (n,) [m/Pa]."""
        return Slope(self.point + point, self.rows, self.reach)

    def __matmul__(self, pressure: np.ndarray) -> np.ndarray:
        """Gap opened by a pressure [m]."""
        if not len(self.rows):
            return self.point * pressure
        return self.point * pressure + self.reach @ (self.rows @ pressure)


@dataclass(frozen=True)
class WearRates:
    """Wear rates at the contact points by the wear laws, as functions of the pressure alone.

    Attributes
    ----------
    laws : list of Law
        Wear laws of the wearing bodies.
    spreads : list of Distribution
        Distributions of the wear of these bodies.
    factors : ndarray, shape (n_wearing, n)
        Factors of the rates.
    states : list of tuple of ndarray, shape (n,)
        Speed, temperature, depth and friction, as in `LocalState`, by wearing body.
    step : float
        Time in which `value` is worn [s].
    """

    laws: list[Law]
    spreads: list[Distribution]
    factors: np.ndarray
    states: list[tuple[np.ndarray, ...]]
    step: float = 1.0

    def __call__(self, pressure: np.ndarray) -> np.ndarray:
        """Wear rates, shape (n_wearing, n) [m/s]."""
        rates = np.empty_like(self.factors)
        for row, law in enumerate(self.laws):
            rates[row] = self.by(law, row, pressure)
        return rates

    def by(self, law: Law, row: int, pressure: np.ndarray) -> np.ndarray:
        """Wear rate of a wearing body by a law, its own or that of one of its layers (n,) [m/s]."""
        spread, local = self.spreads[row], self.local(law, row, pressure)
        own = spread.share * local
        if spread.means is not None:
            own += spread.means.reach @ (spread.means.rows @ local)
        return own

    def local(self, law: Law, row: int, pressure: np.ndarray) -> np.ndarray:
        """Wear rate where a wearing body is in contact, before its distribution, (n,) [m/s]."""
        return self.factors[row] * law.value(LocalState(pressure, *self.states[row]))

    def depths(self, pressure: np.ndarray) -> np.ndarray:
        """Depths worn in the time step, shape (n_wearing, n) [m]."""
        return self.step * self(pressure)

    def value(self, pressure: np.ndarray, last: object = None) -> np.ndarray:
        """Total depth worn in the time step, shape (n,) [m]."""
        return self.step * self(pressure).sum(axis=0)

    def slope(self, pressure: np.ndarray, last: object = None) -> Slope:
        """Derivative of `value` by the pressures [m/Pa]."""
        return self.linearised(pressure, ((row, law, 1.0) for row, law in enumerate(self.laws)))

    def linearised(
        self, pressure: np.ndarray, terms: Iterable[tuple[int, Law, np.ndarray | float]]
    ) -> Slope:
        """Derivative of a sum of depths worn in the time step [m/Pa].

        Parameters
        ----------
        pressure : ndarray, shape (n,) [Pa]
        terms : iterable
            Wearing body, law and weight of the rate of each term; a weight for each point or all.
        """
        n = len(pressure)
        point, rows, reach = np.zeros(n), [np.zeros((0, n))], [np.zeros((n, 0))]
        for row, law, weight in terms:
            spread = self.spreads[row]
            local = self.factors[row] * law.slope(LocalState(pressure, *self.states[row]))
            point += local * (weight * spread.share)
            if spread.means is not None and spread.means.varies:
                rows.append(spread.means.rows * local)
                reach.append(np.reshape(weight, (-1, 1)) * spread.means.reach)
        return Slope(self.step * point, self.step * np.vstack(rows), np.hstack(reach))


def newton_with_wear(
    solve: Callable[[np.ndarray, Any, Solution], Solution],
    wear: PressureDependentWear,
    guess: Solution,
    tolerance: float = _TOLERANCE,
    failure: str = _FAILED,
    rounding: float = 0.0,
) -> Solution:
    """Solve contact with pressure-dependent wear in an implicit step by Newton's method.

    Parameters
    ----------
    solve : callable
        Contact for linearised wear (its value at zero pressure, its slope) and a guess.
    wear : PressureDependentWear
    guess : object
        Contact solution with a pressure.
    tolerance : float, optional
        Error of the linearised wear, relative to its largest value.
    failure : str, optional
        Message of the error.
    rounding : float, optional
        Error that is rounding, whatever the wear.

    Raises
    ------
    ComputationError
        If the iteration does not converge.
    """
    pressure, least = guess.pressure, np.inf
    for _ in range(_STEPS):
        value, slope = wear.value(pressure, guess), wear.slope(pressure, guess)
        guess = solve(value - slope @ pressure, slope, guess)
        exact = wear.value(guess.pressure, guess)
        error = np.abs(exact - value - slope @ (guess.pressure - pressure)).max()
        if error <= max(tolerance * np.abs(exact).max(), rounding):
            return guess
        back = 0.0 if error < least else 0.5
        pressure, least = back * pressure + (1 - back) * guess.pressure, min(error, least)
    raise ComputationError(failure)


@dataclass(frozen=True)
class LayeredStep:
    """Wear in a time step as a function of the pressure at its end.

    Where wear is spread over a track, each layer has the rate that the track would have if all of
    it had reached that layer: points with common means have the same depth.

    Attributes
    ----------
    rates : WearRates
        Rates by the laws of the wearing bodies, and the time step.
    before : ndarray, shape (n_wearing, n)
        Depths before the step [m].
    """

    rates: WearRates
    before: np.ndarray

    def depths(self, pressure: np.ndarray) -> np.ndarray:
        """Depths worn in the time step, shape (n_wearing, n) [m]."""
        worn = np.zeros_like(self.before)
        for row in range(len(worn)):
            worn[row] = self._passage(row, pressure).depth
        return worn

    def value(self, pressure: np.ndarray, last: object = None) -> np.ndarray:
        """Total depth worn in the time step, shape (n,) [m]."""
        return self.depths(pressure).sum(axis=0)

    def slope(self, pressure: np.ndarray, last: object = None) -> Slope:
        """Derivative of `value` by the pressures [m/Pa]."""
        return self.rates.linearised(pressure, self._terms(pressure))

    def _terms(self, pressure: np.ndarray) -> Iterator[tuple[int, Law, np.ndarray | float]]:
        """Wearing body, law and part of the time step of each layer, see `LayerPassage.by_rate`."""
        for row, law in enumerate(self.rates.laws):
            parts = self._passage(row, pressure).by_rate / self.rates.step
            for layer, part in zip(layers_of(law).laws, parts, strict=True):
                yield row, layer, part

    def _passage(self, row: int, pressure: np.ndarray) -> LayerPassage:
        layers = layers_of(self.rates.laws[row])
        rates = np.array([self.rates.by(law, row, pressure) for law in layers.laws])
        return layers.passage(self.before[row], rates, self.rates.step)
