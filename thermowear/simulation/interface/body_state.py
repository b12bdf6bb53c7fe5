"""State of the bodies under a known contact pressure: temperatures, displacements, balances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...balances import require
from ...contact.operators.traces import vector_trace
from ...parallel import sum_over_ranks
from ..heat.friction_heat import TemperatureField, friction_heat
from ..system.conditions import ConditionModel
from ..system.system import System
from .equilibrium import ContactState, SupportForces, force_error, support_forces


def contact_state(
    system: System, pressure: np.ndarray, shear: np.ndarray | None = None
) -> ContactState:
    """State of a contact whose conditions depend on the contact set alone. Every rank calls."""
    conditions = ConditionModel(system).at(0.0, pressure, None, pressure > 0)
    heat = friction_heat(system)
    temperatures = None if heat is None else heat.steady(conditions, pressure)
    return ContactState(pressure, conditions, temperatures, shear)


@dataclass(frozen=True)
class BodyState:
    """Fields of the bodies and their effect on the interfaces.

    Attributes
    ----------
    displacement : ndarray, shape (n_owned,)
        Displacement without the holder's rigid motion [m].
    temperatures : TemperatureField or None
        Temperatures; None without heat.
    opening : ndarray, shape (n,)
        ``B u``: change of the gap at the contact points by load and heat [m].
    hottest : float
        Highest temperature of the bodies [K]; NaN without heat.
    supports : SupportForces
    force_error : float
        Relative error of the balance of forces.
    """

    displacement: np.ndarray
    temperatures: TemperatureField | None
    opening: np.ndarray
    hottest: float
    supports: SupportForces
    force_error: float

    def require_balance(self) -> None:
        """Raise a `ComputationError` if heat or forces are not balanced."""
        require(equilibrium_relative_error=self.force_error)
        if self.temperatures is not None:
            require(heat_balance_relative_error=self.temperatures.error)


def opening_by(system: System, contact: ContactState) -> np.ndarray:
    """Change of the gap at the contact points (n,) by load and heat [m]; every rank calls."""
    system = system.with_friction(contact.conditions.friction)
    displacement = system.elastic.solve(_loads(system, contact)[0])
    return sum_over_ranks(system.comm, system.trace.T @ displacement)


def _loads(system: System, contact: ContactState) -> tuple[np.ndarray, np.ndarray]:
    """Nodal loads, and their part by constrained thermal expansion, shape (n_owned,) [N]."""
    loads = system.traction @ (system.weights * contact.pressure)
    if contact.shear is not None:
        along = vector_trace(system.elastic.spaces, system.contacts, -contact.shear)
        loads = loads + along @ system.weights
    if system.dead_load is not None:
        loads = loads + system.dead_load
    strained = np.zeros(len(system.elastic.fixed))
    if contact.temperatures is not None and system.thermal is not None:
        strained = system.thermal.forces(contact.temperatures.rise)
    return loads + strained, strained


def body_state(system: System, contact: ContactState) -> BodyState:
    """Solve the bodies for given contact loads. Every rank calls."""
    system = system.with_friction(contact.conditions.friction)
    temperatures, hottest = contact.temperatures, float("nan")
    loads, strained = _loads(system, contact)
    if temperatures is not None and system.thermal is not None:
        if system.choice.solves_once:
            system.thermal.conduction.release()
        highest = max(system.comm.allgather(float(temperatures.rise.max(initial=-np.inf))))
        hottest = max(highest, float(np.max(temperatures.faces.rise))) + system.thermal.ambient
    displacement = system.elastic.solve(loads)
    opening = sum_over_ranks(system.comm, system.trace.T @ displacement)
    supports = support_forces(system, displacement, loads, strained)
    error = force_error(system, contact, supports)
    return BodyState(displacement, temperatures, opening, hottest, supports, error)
