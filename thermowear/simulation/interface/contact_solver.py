"""Interface of contact solvers, and wear rates with their derivative."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ...laws.distribution import Distribution
from ...laws.interfaces import Law
from ...serialise import serialisable
from ..heat.heat_steps import HeatStep
from ..system.conditions import InterfaceConditions


@serialisable
@dataclass(frozen=True)
class ContactSolution:
    """Solution of a contact problem.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    motion : ndarray, shape (n_modes,)
        Amount of each rigid mode of the holder [m or rad].
    warm_start : object
        Solution to start the solver from.
    apart : ndarray or None, shape (n,)
        Gap of the points with pointwise contact: 0 where they press, NaN at other points; None
        without such points [m].
    """

    pressure: np.ndarray
    motion: np.ndarray
    warm_start: Any
    apart: np.ndarray | None = None


class ContactSolver(Protocol):
    """Solver of contact under given loads: condensed, or on the full system.

    Attributes
    ----------
    note : str or None
        Warning about the settings of the solver.
    """

    note: str | None

    def solve(
        self,
        gap: np.ndarray,
        slope: Slope,
        guess: ContactSolution | None,
        conditions: InterfaceConditions,
        heat: HeatStep | None,
        pointwise: np.ndarray | None = None,
    ) -> ContactSolution:
        """Solve contact of bodies with friction heat and a local compliance.

        Parameters
        ----------
        gap : ndarray, shape (n,)
            Gap without pressure, heat and motion of the holder [m].
        slope : Slope
            Gap per pressure in addition to the deflection of the bodies [m/Pa].
        guess : ContactSolution or None
        conditions : InterfaceConditions
        heat : HeatStep or None
        pointwise : ndarray of bool, shape (n,), optional
            Points at the edge of the wear with pointwise contact, see `contact.wear.wear_edge`.

        Raises
        ------
        ComputationError
        """

    def yielding(self, points: np.ndarray) -> np.ndarray:
        """Deflection per pressure of a single point, NaN at other points, shape (n,) [m/Pa].

        Parameters
        ----------
        points : ndarray of bool, shape (n,)
            From `WearEdge.points`.
        """

    def steady(
        self, pressure: np.ndarray, rates: WearRates, conditions: InterfaceConditions
    ) -> np.ndarray:
        """Steady pressure in the discretisation of the solver, from that of the principle [Pa].

        Parameters
        ----------
        pressure : ndarray, shape (n,) [Pa]
        rates : WearRates
        conditions : InterfaceConditions
            Conditions in the steady state.
        """

    def opening(self, contact: ContactSolution) -> float:
        """Largest change of the gap by elastic deflection [m]."""

    def bending(self, contact: ContactSolution) -> float:
        """Range of the elastic deflection over the contact area [m]."""


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
    """Wear rates at the contact points under given conditions.

    Attributes
    ----------
    laws : list of Law
        Wear laws of the wearing bodies.
    spreads : list of Distribution
        Distributions of the wear of these bodies.
    conditions : InterfaceConditions
    step : float
        Time in which `value` is worn, see `contact.wear.implicit_step` [s].
    """

    laws: list[Law]
    spreads: list[Distribution]
    conditions: InterfaceConditions
    step: float = 1.0

    def __call__(self, pressure: np.ndarray) -> np.ndarray:
        """Wear rates, shape (n_wearing, n) [m/s]."""
        rates = np.zeros_like(self.conditions.wear)
        for row, (law, spread) in enumerate(zip(self.laws, self.spreads, strict=True)):
            rates[row] = spread.rate(self.conditions.wear_rate(row, law, pressure))
        return rates

    def value(self, pressure: np.ndarray, last: object = None) -> np.ndarray:
        """Total depth worn in the time step, shape (n,) [m]."""
        return self.step * self(pressure).sum(axis=0)

    def slope(self, pressure: np.ndarray, last: object = None) -> Slope:
        """Derivative of `value` by the pressures [m/Pa]."""
        n = len(pressure)
        point, rows, reach = np.zeros(n), [np.zeros((0, n))], [np.zeros((n, 0))]
        for row, (law, spread) in enumerate(zip(self.laws, self.spreads, strict=True)):
            local = self.conditions.wear_slope(row, law, pressure)
            point += spread.share * local
            if spread.varying_rows is not None:
                rows.append(spread.varying_rows * local)
                reach.append(spread.reach(n))
        return Slope(self.step * point, self.step * np.vstack(rows), np.hstack(reach))
