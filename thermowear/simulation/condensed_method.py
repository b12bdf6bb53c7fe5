"""Contact solved on the condensed interface: small and dense."""

from __future__ import annotations

import numpy as np

from ..contact.complementarity import ContactSolution, NoEquilibrium, solve_contact
from ..contact.condensation import CondensedContact
from ..errors import ComputationError
from .contact_method import Contact, Slope, WearRates, newton_with_wear
from .system import System

_TURNS = 60
_HOT = (
    "with friction heat this happens beyond the critical sliding speed (thermoelastic "
    "instability): reduce the speed, or the expansion, or the friction"
)
_LOCKED = (
    "friction along the faces locks body 1 or tips it over an edge: lower contact.friction, turn "
    "the motion round, or change the line of the load or the free motions of the holder"
)
_TIPPED = (
    "the load lifts body 1 off or tips it over an edge: change the line of the load or the free "
    "motions of the holder"
)


class CondensedMethod:
    """The contact conditions in the pressure space, with gaps measured weakly.

    Parameters
    ----------
    system : System
    """

    def __init__(self, system: System):
        self._system = system
        self._contact = system.contact
        nominal = np.full(len(system.weights), system.friction)
        self._rubbing = (nominal.tobytes(), self._contact)
        self._dead = system.gap - system.pairing.gap
        self.note: str | None = None

    def solve(self, gap, slope, guess: Contact | None, conditions, heat) -> Contact:
        try:
            return self._balanced(gap, slope, guess, conditions, heat)
        except NoEquilibrium as error:
            cold = _LOCKED if conditions.friction.any() else _TIPPED
            raise ComputationError(f"{error}; {cold if heat is None else _HOT}") from None

    def _balanced(self, gap, slope, guess: Contact | None, conditions, heat) -> Contact:
        bodies = self._rubbed(conditions.friction)
        compliance, weak = bodies.compliance, bodies.weak(gap + self._dead)
        if heat is None:
            return self._solved(bodies, compliance, weak, slope, guess, conditions.load)
        for _ in range(_TURNS):
            hot = heat.coupling(conditions, bodies.basis)
            guess = self._solved(
                bodies,
                compliance + hot.compliance,
                weak + hot.resting,
                slope,
                guess,
                conditions.load,
            )
            if heat.holds(conditions, guess.pressure):
                return guess
        raise ComputationError(
            "contact: pressure and temperatures do not settle where conductivity or expansion "
            "change; reduce the speed"
        )

    def steady(self, pressure, rates: WearRates, conditions) -> np.ndarray:
        """The principle in the pressure space.

        The mean wear rates, weighted by the basis, are those of the rigid motion. That is the
        implicit step of wear of bodies that do not yield.
        """
        contact, load = self._rubbed(conditions.friction), conditions.load
        coefficients = np.linalg.lstsq(contact.basis, pressure, rcond=None)[0]
        active = np.ones(len(coefficients), dtype=bool)
        still = np.zeros(contact.modes.shape[1])
        start = Contact(pressure, still, ContactSolution(coefficients, still, active))
        rigid = np.zeros_like(contact.compliance)
        return newton_with_wear(
            lambda worn, slope, last: self._solved(
                contact, rigid, contact.weak(worn), slope, last, load
            ),
            rates,
            1.0,
            start,
        ).pressure

    def opening(self, contact: Contact) -> float:
        opened = self._contact.compliance @ contact.memory.coefficients
        return float((opened / self._contact.weighted.sum(axis=0)).max())

    def _rubbed(self, friction: np.ndarray) -> CondensedContact:
        """The condensed bodies under the present friction (n,); the last one is kept."""
        key = friction.tobytes()
        if self._rubbing[0] != key:
            self._rubbing = (key, self._system.rubbing(friction).contact)
        return self._rubbing[1]

    def _solved(
        self, contact: CondensedContact, compliance, weak, slope: Slope, guess, load
    ) -> Contact:
        if slope.point.any():
            compliance = compliance + contact.weighted.T @ (slope.point[:, None] * contact.basis)
        if len(slope.rows):
            compliance = compliance + contact.weak(slope.reach) @ (slope.rows @ contact.basis)
        solution = solve_contact(
            compliance,
            weak,
            contact.modes,
            load,
            None if guess is None else guess.memory.active,
            contact.force_modes,
        )
        pressure = contact.basis @ solution.coefficients
        return Contact(pressure, self._system.holder.amounts(solution.motion), solution)
