"""State of the bodies under a known contact pressure: temperatures, displacements, balances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...balances import ALLOWED, relative, require
from ...compat import coordinate_element
from ...contact.operators.rigid_motion import RigidMode
from ...contact.operators.tangential import tangents
from ...contact.operators.traces import vector_trace
from ...laws.motions import RigidMotion, translation
from ...parallel import sum_over_ranks
from ..heat.friction_heat import TemperatureField, friction_heat
from ..system.conditions import ConditionModel, InterfaceConditions
from ..system.system import System

_ROUNDING = 1e-11
"""Reactions at this fraction of the forces of constrained thermal expansion are rounding errors."""


@dataclass(frozen=True)
class ContactState:
    """Contact loads on the bodies: pressure, shear and friction heat.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
    conditions : InterfaceConditions
    temperatures : TemperatureField or None
        Temperatures; None without heat.
    shear : ndarray or None, shape (n,)
        Stick-slip traction on body 1, see `contact.operators.tangential` [Pa].
    """

    pressure: np.ndarray
    conditions: InterfaceConditions
    temperatures: TemperatureField | None
    shear: np.ndarray | None = None

    def traction(self, system: System) -> np.ndarray:
        """Traction on body 2 in a system with this friction, shape (n, gdim) [Pa]."""
        traction = self.pressure[:, None] * system.traction_direction
        if self.shear is None:
            return traction
        return traction - self.shear[:, None] * tangents(system.contacts.normals)[0]


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
    force_error : float
        Relative error of the balance of forces.
    """

    displacement: np.ndarray
    temperatures: TemperatureField | None
    opening: np.ndarray
    hottest: float
    force_error: float

    def require_balance(self) -> None:
        """Raise a `ComputationError` if heat or forces are not balanced."""
        require(equilibrium_relative_error=self.force_error)
        if self.temperatures is not None:
            require(heat_balance_relative_error=self.temperatures.error)


def body_state(system: System, contact: ContactState) -> BodyState:
    """Solve the bodies for given contact loads. Every rank calls."""
    system = system.with_friction(contact.conditions.friction)
    pressure, shear, temperatures = contact.pressure, contact.shear, contact.temperatures
    hottest, strained = float("nan"), np.zeros(len(system.elastic.fixed))
    loads = system.traction @ (system.weights * pressure)
    if shear is not None:
        contacts = system.contacts
        along = vector_trace(system.elastic.spaces, contacts, -tangents(contacts.normals)[0])
        loads = loads + along @ (system.weights * shear)
    if system.dead_load is not None:
        loads = loads + system.dead_load
    if temperatures is not None and system.thermal is not None:
        strained = system.thermal.forces(temperatures.rise)
        if system.choice.solves_once:
            system.thermal.conduction.release()
        highest = max(system.comm.allgather(float(temperatures.rise.max(initial=-np.inf))))
        hottest = max(highest, float(np.max(temperatures.faces.rise))) + system.thermal.ambient
    loads = loads + strained
    displacement = system.elastic.solve(loads)
    opening = sum_over_ranks(system.comm, system.trace.T @ displacement)
    force_error = _force_error(system, contact, displacement, loads, strained)
    return BodyState(displacement, temperatures, opening, hottest, force_error)


def _force_error(system: System, contact: ContactState, displacement, loads, strained) -> float:
    """Relative error between support reactions and the forces of holders and contacts.

    On each body supports and joints must balance the contact along each rigid mode, and across
    them the guides do; those on the bodies of a holder must equal its load along its free motions.
    Moments of the contact act on each body at its own points. Relative to the sum of the
    magnitudes, for translations of all forces. Where no force acts, as on hot bodies apart,
    reactions are the rounding of the thermal forces ``strained`` (n_owned,), without their part
    that grows beyond bounds towards ν = 0.5.
    """
    rigid_modes = [*_with_rotations(system, contact), *((m, None) for m in _across(system))]
    nodes = system.elastic.nodes()
    reactions = system.elastic.reactions(displacement, loads)
    reactions = (reactions + system.elastic.joint_forces(displacement, loads)).reshape(nodes.shape)
    owned = [system.elastic.owned_by(*body.parts) for body in system.model.bodies]
    errors, scales = np.zeros(len(rigid_modes)), np.zeros(len(rigid_modes))
    strained = system.elastic.compressibility() * strained.reshape(nodes.shape)
    for k, (mode, load) in enumerate(rigid_modes):
        moved = mode.motion.at(nodes)
        work = (reactions * moved).sum(axis=1)
        magnitudes = np.abs(work).sum(), np.abs(strained * moved).sum()
        parts = np.array([*(work[own].sum() for own in owned), *magnitudes])
        *held, borne, thermal = sum_over_ranks(system.comm, parts)
        given = system.dead_resultant(mode.motion)
        found, carried = _borne_by_bodies(system, contact, mode.motion)
        errors[k] = np.abs(np.array(held) - (found - given)).max()
        if load is not None:
            errors[k] = max(errors[k], abs(sum(held[body] for body in mode.bodies) - load))
        scales[k] = max(carried + np.abs(given).sum(), borne, _ROUNDING / ALLOWED * thermal)
    shifts = np.array([not mode.motion.rotation.any() for mode, _ in rigid_modes])
    scales[shifts] = scales[shifts].max()
    return max(relative(e, s) for e, s in zip(errors, scales, strict=True))


def _with_rotations(system: System, contact: ContactState) -> list[tuple[RigidMode, float | None]]:
    """Rigid modes of the holders that the elements represent without strain, with their loads.

    Loads are the present ones; None for given motions, and where friction sticks. Rotations are
    linear in the coordinates: in cells with a geometry of higher degree than the displacement they
    cause small strains, and moments balance only within the discretisation error.
    """
    degree = system.model.discretisation.degree
    curved = any(coordinate_element(body.mesh).degree > degree for body in system.bodies.each)
    present = iter(contact.conditions.load - system.holder.dead)
    loads = [None if mode.load is None else next(present) for mode in system.holder.rigid_modes]
    return [
        (mode, load if contact.shear is None else None)
        for mode, load in zip(system.holder.rigid_modes, loads, strict=True)
        if not (curved and mode.motion.rotation.any())
    ]


def _borne_by_bodies(
    system: System, contact: ContactState, motion: RigidMotion
) -> tuple[np.ndarray, float]:
    """Work of a motion of each body against the contact, (n_bodies,), and sum of magnitudes."""
    contacts, traction = system.contacts, contact.traction(system)
    result, magnitude = np.zeros(len(system.model.bodies)), 0.0
    for body in range(len(result)):
        for side, points in contacts.of_body(body):
            at = (contacts.on_body_1, contacts.on_body_2)[side][points]
            work = contacts.weights[points] * np.einsum("ni,ni->n", motion.at(at), traction[points])
            result[body] += (1.0, -1.0)[side] * work.sum()
            magnitude += np.abs(work).sum() / 2
    return result, magnitude


def _across(system: System) -> list[RigidMode]:
    """Translations along the axes without a load, balanced independently of the holder."""
    gdim = system.contacts.points.shape[1]
    axes = [(0.0, 1.0)] if system.model.kinematics == "axisymmetric" else np.eye(gdim)
    return [RigidMode(translation(axis), amplitude=0.0) for axis in axes]
