"""Contact solved on the condensed interface: small and dense."""

from __future__ import annotations

import numpy as np

from ..contact.complementarity import ContactSolution, solve_contact
from .friction_heat import FrictionHeat
from .interface_problem import Contact, WearRates, newton_with_wear
from .system import System


class CondensedMethod:
    """The contact conditions in the pressure space, with gaps measured weakly.

    Parameters
    ----------
    system : System
    heat : FrictionHeat or None
    """

    def __init__(self, system: System, heat: FrictionHeat | None):
        self._system = system
        self._contact = system.contact
        self._dead = system.gap - system.pairing.gap
        self._heat = heat
        self.note: str | None = None

    def solve(self, gap, slope, guess: Contact | None, closed) -> Contact:
        contact = self._contact
        compliance, weak = contact.compliance, contact.weak(gap + self._dead)
        if self._heat is not None:
            coupling = self._heat.coupling(closed)
            compliance, weak = compliance + coupling.compliance, weak + coupling.resting
        return self._solved(compliance, weak, slope, guess)

    def steady(self, pressure, rates: WearRates) -> np.ndarray:
        """The principle in the pressure space.

        The mean wear rates, weighted by the basis, are those of the rigid motion. That is the
        implicit step of wear of bodies that do not yield.
        """
        contact = self._contact
        coefficients = np.linalg.lstsq(contact.basis, pressure, rcond=None)[0]
        active = np.ones(len(coefficients), dtype=bool)
        still = np.zeros(contact.modes.shape[1])
        start = Contact(pressure, still, ContactSolution(coefficients, still, active))
        rigid = np.zeros_like(contact.compliance)
        return newton_with_wear(
            lambda worn, slope, last: self._solved(rigid, contact.weak(worn), slope, last),
            rates,
            1.0,
            start,
        ).pressure

    def opening(self, contact: Contact) -> float:
        opened = self._contact.compliance @ contact.memory.coefficients
        return float((opened / self._contact.weighted.sum(axis=0)).max())

    def _solved(self, compliance, weak, slope, guess: Contact | None) -> Contact:
        contact = self._contact
        if slope.any():
            compliance = compliance + contact.weighted.T @ (slope[:, None] * contact.basis)
        solution = solve_contact(
            compliance,
            weak,
            contact.modes,
            self._system.holder.load,
            None if guess is None else guess.memory.active,
            contact.force_modes,
        )
        pressure = contact.basis @ solution.coefficients
        return Contact(pressure, self._system.holder.amounts(solution.motion), solution)
