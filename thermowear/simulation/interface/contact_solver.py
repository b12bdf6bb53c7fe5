"""Ways to solve contact, and what an implicit step of wear asks of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ...errors import ComputationError
from ...laws.distribution import Distribution
from ...laws.interfaces import WearRate
from ...serialise import serialisable
from ..heat.heat_stages import HeatStage
from ..model.conditions import InterfaceConditions

_NEWTON_STEPS = 40


@serialisable
@dataclass(frozen=True)
class ContactSolution:
    """A solved contact.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    motion : ndarray, shape (n_drives,)
        How far the holder has made each of its motions [m or rad].
    memory : object
        What the method that solved it starts from next time.
    apart : ndarray or None, shape (n,)
        Gap of the points at which contact holds one by one: 0 where they press, NaN elsewhere;
        None without such points [m].
    """

    pressure: np.ndarray
    motion: np.ndarray
    memory: Any
    apart: np.ndarray | None = None


class ContactSolver(Protocol):
    """A way to solve contact with given loads: condensed, or on the full system.

    Attributes
    ----------
    note : str or None
        What the user should know about its settings.
    """

    note: str | None

    def solve(
        self,
        gap: np.ndarray,
        slope: Slope,
        guess: ContactSolution | None,
        conditions: InterfaceConditions,
        heat: HeatStage | None,
        pointwise: np.ndarray | None = None,
    ) -> ContactSolution:
        """Contact of bodies with friction heat and a local compliance.

        Parameters
        ----------
        gap : ndarray, shape (n,)
            Without pressure, heat and motion of the holder [m].
        slope : Slope
            Gap that the pressures open in addition to the bodies [m/Pa].
        guess : ContactSolution or None
        conditions : InterfaceConditions
        heat : HeatStage or None
        pointwise : ndarray of bool, shape (n,), optional
            At the edge of the wear, where contact is to hold one by one: `contact.wear_edge`.

        Raises
        ------
        ComputationError
        """

    def yielding(self, points: np.ndarray) -> np.ndarray:
        """Deflection under the pressure of single points, NaN at others, shape (n,) [m/Pa].

        Parameters
        ----------
        points : ndarray of bool, shape (n,)
            From `WearEdge.points`.
        """

    def steady(
        self, pressure: np.ndarray, rates: WearRates, conditions: InterfaceConditions
    ) -> np.ndarray:
        """Steady pressure as the method discretises it, from that of the principle [Pa].

        Parameters
        ----------
        pressure : ndarray, shape (n,) [Pa]
        rates : WearRates
        conditions : InterfaceConditions
            That the steady state leads to.
        """

    def opening(self, contact: ContactSolution) -> float:
        """Largest change of the gap by the bodies' deformation [m]."""

    def bending(self, contact: ContactSolution) -> float:
        """By how much that differs over the area that presses [m]."""


@dataclass(frozen=True)
class Slope:
    """Derivative of a local opening of the gap by the pressures.

    Attributes
    ----------
    point : ndarray, shape (n,)
        By the pressure on the spot [m/Pa].
    rows : ndarray, shape (k, n)
        Of k means by the pressures at the points [m/Pa].
    reach : ndarray, shape (n, k)
        How much of each mean each point has.
    """

    point: np.ndarray
    rows: np.ndarray
    reach: np.ndarray

    @classmethod
    def on_the_spot(cls, point: np.ndarray) -> Slope:
        """Without means."""
        return cls(point, np.zeros((0, len(point))), np.zeros((len(point), 0)))

    def times(self, step: float) -> Slope:
        """The same for a longer or shorter step."""
        return Slope(step * self.point, step * self.rows, self.reach)

    def softer_by(self, point: np.ndarray) -> Slope:
        """The same with something more that opens on the spot (n,) [m/Pa]."""
        return Slope(self.point + point, self.rows, self.reach)

    def opened(self, pressure: np.ndarray) -> np.ndarray:
        """By a pressure (n,) [m]."""
        return self.point * pressure + self.reach @ (self.rows @ pressure)


@dataclass(frozen=True)
class WearRates:
    """The wear laws at the contact points.

    Attributes
    ----------
    laws : list of WearRate
        Of the wearing bodies.
    spreads : list of Distribution
        Of the same bodies.
    conditions : InterfaceConditions
    """

    laws: list[WearRate]
    spreads: list[Distribution]
    conditions: InterfaceConditions

    def __call__(self, pressure: np.ndarray) -> np.ndarray:
        """Wear rates, shape (n_wearing, n) [m/s]."""
        rates = np.zeros_like(self.conditions.wear)
        for row, (law, spread) in enumerate(zip(self.laws, self.spreads, strict=True)):
            rates[row] = spread.rate(self.conditions.wear_rate(row, law, pressure))
        return rates

    def slope(self, pressure: np.ndarray) -> Slope:
        """Derivative of their sum by the pressures [m/s/Pa]."""
        n = len(pressure)
        point, rows, reach = np.zeros(n), [np.zeros((0, n))], [np.zeros((n, 0))]
        for row, (law, spread) in enumerate(zip(self.laws, self.spreads, strict=True)):
            local = self.conditions.wear_slope(row, law, pressure)
            point += spread.share * local
            if spread.varying_rows is not None:
                rows.append(spread.varying_rows * local)
                reach.append(spread.reach(n))
        return Slope(point, np.vstack(rows), np.hstack(reach))


def newton_with_wear(
    solve, rates: WearRates, step: float, guess: ContactSolution
) -> ContactSolution:
    """Newton's method on contact with wear that grows with the pressure.

    Parameters
    ----------
    solve : callable
        Contact for a worn depth at zero pressure (n,), its slope by the pressures, and a guess.
    rates : WearRates
    step : float
        [s]
    guess : ContactSolution

    Raises
    ------
    ComputationError
    """
    pressure = guess.pressure
    for _ in range(_NEWTON_STEPS):
        rate = step * rates(pressure).sum(axis=0)
        slope = rates.slope(pressure).times(step)
        guess = solve(rate - slope.opened(pressure), slope, guess)
        change = guess.pressure - pressure
        pressure = guess.pressure
        exact = step * rates(pressure).sum(axis=0)
        if np.abs(exact - rate - slope.opened(change)).max() <= 1e-11 * np.abs(exact).max():
            return guess
    raise ComputationError("contact: Newton's method for the implicit step of wear failed")
