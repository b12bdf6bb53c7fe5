"""Contact at the end of an implicit step of wear, for given interface conditions."""

from __future__ import annotations

import numpy as np

from ...contact.wear.implicit_step import newton_with_wear
from ..heat.heat_steps import HeatStep
from ..system.conditions import InterfaceConditions
from ..system.system import System
from .contact_solver import ContactSolution, ContactSolver, Slope, WearRates


class ImplicitContact:
    """Contact of the bodies of a system with worn faces, by an implicit step of wear.

    Parameters
    ----------
    system : System
    method : ContactSolver
    """

    def __init__(self, system: System, method: ContactSolver):
        self._system = system
        self._method = method
        self._gap = system.pairing.gap - system.holder.imposed
        self._softness = np.full(len(self._gap), system.softness)
        self._laws, self._spreads = list(system.laws.values()), list(system.spreads.values())

    @property
    def unworn(self) -> np.ndarray:
        """Zero wear depths, shape (n_wearing, n)."""
        return np.zeros((len(self._laws), len(self._gap)))

    @property
    def guess(self) -> ContactSolution:
        """Initial guess: the mean pressure, uniform over the face."""
        area = float(self._system.weights.sum())
        pressure = np.full(len(self._gap), (self._system.model.holder.force or area) / area)
        return ContactSolution(pressure, np.zeros(0), None)

    def rates(self, conditions: InterfaceConditions, step: float = 1.0) -> WearRates:
        """Wear rates under given conditions, for wear in a time step [s]."""
        return WearRates(self._laws, self._spreads, conditions, step)

    def solve(
        self,
        worn: np.ndarray,
        conditions: InterfaceConditions,
        heat: HeatStep | None,
        pointwise: np.ndarray | None = None,
        guess: ContactSolution | None = None,
        step: float = 0.0,
    ) -> ContactSolution:
        """Solve contact at the end of an implicit step of wear by Newton's method.

        Each Newton step is a contact problem: pressure-dependent wear adds ``step · ∂rate/∂p`` to
        the compliance of each point.

        Parameters
        ----------
        worn : ndarray, shape (n_rows, n)
            Wear depths before the step [m].
        conditions : InterfaceConditions
        heat : HeatStep or None
        pointwise : ndarray of bool or None, shape (n,)
            See `ContactSolver.solve`.
        guess : ContactSolution, optional
        step : float
            No wear by default [s].
        """
        gap = self._gap + worn.sum(axis=0)
        if conditions.released:  # the holder stays where it is
            motion = (
                np.zeros(len(self._system.holder.rigid_modes)) if guess is None else guess.motion
            )
            return ContactSolution(np.zeros(len(gap)), motion, None)

        def solve(opened, slope, last):
            softened = slope.with_compliance(self._softness)
            return self._method.solve(gap + opened, softened, last, conditions, heat, pointwise)

        still = np.zeros(len(gap))
        rigid = Slope.diagonal(still)
        if guess is not None and guess.warm_start is None:
            guess = None
        if step == 0.0 or not self._laws:
            return solve(still, rigid, guess)
        guess = guess or solve(still, rigid, None)
        return newton_with_wear(solve, self.rates(conditions, step), guess)
