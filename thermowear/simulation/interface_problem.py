"""The interface alone: contact, friction heat and an implicit step of wear, small and dense."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..contact.complementarity import ContactSolution, solve_contact
from ..errors import ComputationError
from .friction_heat import FrictionHeat
from .system import System

_NEWTON_STEPS = 40


class InterfaceProblem:
    """Contact with heat and wear for given loads.

    Parameters
    ----------
    system : System
    """

    def __init__(self, system: System):
        self._contact = system.contact
        self._initial = self._contact.weak(system.pairing.gap)
        self._load = system.load
        self._speed = system.speed
        self._laws = list(system.laws.values())
        self._heat = None
        if system.thermal is not None and system.distortion is not None:
            self._heat = FrictionHeat(system, system.thermal, system.distortion)

    def pressure(self, solution: ContactSolution) -> np.ndarray:
        """Pressure at the points [Pa]."""
        return self._contact.basis @ solution.coefficients

    def rates(self, pressure: np.ndarray) -> np.ndarray:
        """Wear rates of the wearing bodies, shape (n_wearing, n) [m/s]."""
        return np.array([law.rate(pressure, self._speed) for law in self._laws])

    def deflection(self, solution: ContactSolution) -> float:
        """Largest elastic (mean) opening of the gap under a pressure [m]."""
        opened = self._contact.compliance @ solution.coefficients
        return float((opened / self._contact.weighted.sum(axis=0)).max())

    def hottest(self, pressure: np.ndarray) -> float:
        """Highest temperature of both faces [K]; NaN without heat."""
        return float("nan") if self._heat is None else self._heat.hottest(pressure)

    def unworn(self) -> ContactSolution:
        """Contact of the unworn faces; the points that exchange heat are found by iteration.

        Raises
        ------
        ComputationError
            If the set of touching points does not settle.
        """
        nothing = np.zeros(len(self._speed))
        closed = nothing == 0
        for _ in range(50):
            solution = self.solve(nothing, 0.0, None, closed)
            touching = self.pressure(solution) > 0
            if self._heat is None or np.array_equal(touching, closed):
                return solution
            closed = touching
        raise ComputationError(
            "contact: the touching points do not settle under friction heat; "
            "give the contact a (smaller) heat.conductance"
        )

    def solve(
        self,
        worn: np.ndarray,
        step: float,
        guess: ContactSolution | None,
        closed: np.ndarray,
    ) -> ContactSolution:
        """Contact at the end of an implicit step of wear, by Newton's method.

        Each Newton step is a complementarity problem: wear that grows with the pressure adds
        ``Ψᵀ w (step · ∂rate/∂p) Ψ`` to the compliance.

        Parameters
        ----------
        worn : ndarray, shape (n,)
            Depth worn off both bodies before the step [m].
        step : float
            [s]; 0 for contact alone.
        guess : ContactSolution or None
        closed : ndarray of bool, shape (n,)
            Points that exchange heat.

        Raises
        ------
        ComputationError
        """
        contact = self._contact
        compliance, resting = self._with_heat(closed)
        base = self._initial + resting + contact.weak(worn)
        if guess is None:
            guess = solve_contact(compliance, base, contact.modes, self._load)
        if step == 0.0:
            return solve_contact(compliance, base, contact.modes, self._load, guess.active)
        return self._with_wear(compliance, base, step, guess)

    def steady(self, pressure: np.ndarray) -> np.ndarray:
        """Steady pressure of the discrete interface: what a running-in of it tends to [Pa].

        The principle in the pressure space: the mean wear rates, weighted by the basis, are those
        of the rigid motion. That is the implicit step of wear of bodies that do not yield.

        Parameters
        ----------
        pressure : ndarray, shape (n,)
            The steady pressure point by point [Pa].
        """
        contact = self._contact
        coefficients = np.linalg.lstsq(contact.basis, pressure, rcond=None)[0]
        active = np.ones(len(coefficients), dtype=bool)
        start = ContactSolution(coefficients, np.zeros(1), active)
        rigid, flat = np.zeros_like(contact.compliance), np.zeros(len(coefficients))
        return self.pressure(self._with_wear(rigid, flat, 1.0, start))

    def _with_wear(
        self, compliance: np.ndarray, base: np.ndarray, step: float, guess: ContactSolution
    ) -> ContactSolution:
        """Newton's method on contact with wear that grows with the pressure."""
        contact = self._contact
        pressure = self.pressure(guess)
        for _ in range(_NEWTON_STEPS):
            rate = step * self.rates(pressure).sum(axis=0)
            slope = step * np.sum([law.slope(pressure, self._speed) for law in self._laws], axis=0)
            matrix = compliance + contact.weighted.T @ (slope[:, None] * contact.basis)
            gap = base + contact.weak(rate - slope * pressure)
            guess = solve_contact(matrix, gap, contact.modes, self._load, guess.active)
            change = self.pressure(guess) - pressure
            pressure = pressure + change
            exact = step * self.rates(pressure).sum(axis=0)
            if np.abs(exact - rate - slope * change).max() <= 1e-11 * np.abs(exact).max():
                return guess
        raise ComputationError("contact: Newton's method for the implicit step of wear failed")

    def _with_heat(self, closed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Compliance with friction heat, and the weak gap of heat from elsewhere."""
        compliance = self._contact.compliance
        if self._heat is None:
            return compliance, np.zeros(len(self._initial))
        coupling = self._heat.coupling(closed)
        return compliance + coupling.compliance, coupling.resting


@dataclass(frozen=True)
class WornContact:
    """State of a running-in.

    Attributes
    ----------
    worn : ndarray, shape (n_wearing, n)
        Depths worn off [m].
    solution : ContactSolution
    pressure : ndarray, shape (n,) [Pa]
    """

    worn: np.ndarray
    solution: ContactSolution
    pressure: np.ndarray
