"""State of the bodies under a known contact pressure, and their equilibrium.

Reactions are residuals of the solved stiffness, forces of contacts and holders are known without
it: their balances show errors of the solution.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...balances import ALLOWED, relative, require
from ...compat import coordinate_element
from ...contact.operators.condensation import vector_trace
from ...contact.operators.rigid_motion import RigidMode
from ...laws.motions import RigidMotion, rotation, translation
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
    shear : ndarray or None, shape (n, gdim)
        Shear traction of stick-slip on the first bodies [Pa].
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
        return traction - self.shear


@dataclass(frozen=True)
class SupportForces:
    """Forces of supports and joints on the nodes of the bodies.

    Attributes
    ----------
    nodal : ndarray, shape (n_nodes, gdim) [N]
    strained : ndarray, shape (n_nodes, gdim)
        Forces of constrained thermal expansion, without their part that grows beyond bounds
        towards ν = 0.5 [N].
    owned : tuple of ndarray of bool, shape (n_nodes,)
        Nodes of each body.
    """

    nodal: np.ndarray
    strained: np.ndarray
    owned: tuple[np.ndarray, ...]


@dataclass(frozen=True)
class Work:
    """Work of a rigid motion of each body against its forces, arrays of shape (n_bodies,).

    Attributes
    ----------
    held : ndarray
        Of supports and joints [N or N m].
    residual : ndarray
        Sum of all forces; zero in equilibrium.
    borne, thermal, carried, given : ndarray
        Magnitudes: of the forces of supports and joints, of constrained thermal expansion, of the
        contacts, and of loads on surfaces.
    """

    held: np.ndarray
    residual: np.ndarray
    borne: np.ndarray
    thermal: np.ndarray
    carried: np.ndarray
    given: np.ndarray

    @property
    def scale(self) -> float:
        """Magnitude of the forces on all bodies; each contact force acts on two of them."""
        loads = self.carried.sum() / 2 + self.given.sum()
        return max(loads, self.borne.sum(), _ROUNDING / ALLOWED * self.thermal.sum())

    @property
    def scales(self) -> np.ndarray:
        """Magnitude of the forces on each body."""
        loads, thermal = self.carried + self.given, _ROUNDING / ALLOWED * self.thermal
        return np.maximum.reduce([loads, self.borne, thermal])


def support_forces(
    system: System, displacement: np.ndarray, loads: np.ndarray, strained: np.ndarray
) -> SupportForces:
    """Forces of supports and joints in a solution (n_owned,); every rank calls.

    Parameters
    ----------
    system : System
    displacement : ndarray, shape (n_owned,) [m]
    loads, strained : ndarray, shape (n_owned,)
        Nodal loads, and the part of them by constrained thermal expansion [N].
    """
    elastic, shape = system.elastic, (-1, system.contacts.points.shape[1])
    nodal = elastic.reactions(displacement, loads) + elastic.joint_forces(displacement, loads)
    owned = tuple(elastic.owned_by(*body.parts) for body in system.model.bodies)
    strained = elastic.compressibility() * strained.reshape(shape)
    return SupportForces(nodal.reshape(shape), strained, owned)


def force_error(system: System, contact: ContactState, supports: SupportForces) -> float:
    """Relative error between support reactions and the forces of holders and contacts.

    On each body supports and joints must balance the contact along each rigid mode, and across
    them the guides do; those on the bodies of a holder must equal its load along its free motions.
    Moments of the contact act on each body at its own points. Relative to the sum of the
    magnitudes, for translations of all forces. Where no force acts, as on hot bodies apart,
    reactions are the rounding of the thermal forces. Every rank calls.
    """
    rigid_modes = [*_with_rotations(system, contact), *((m, None) for m in _across(system))]
    errors, scales = np.zeros(len(rigid_modes)), np.zeros(len(rigid_modes))
    for k, (mode, load) in enumerate(rigid_modes):
        work = work_of(system, contact, supports, mode.motion)
        errors[k] = np.abs(work.residual).max()
        if load is not None:
            errors[k] = max(errors[k], abs(work.held[list(mode.bodies)].sum() - load))
        scales[k] = work.scale
    shifts = np.array([not mode.motion.rotation.any() for mode, _ in rigid_modes])
    scales[shifts] = scales[shifts].max()
    return max(relative(e, s) for e, s in zip(errors, scales, strict=True))


@dataclass(frozen=True)
class BodyEquilibrium:
    """Relative errors of the equilibrium of each body.

    Attributes
    ----------
    forces : list of float
        Relative to the forces on the body.
    moments : list of float or None
        About the middle of the contacts, relative to the forces on the body times its size; None
        where no moment is transmitted in the model, or moments balance within the discretisation
        error only, see `_exact_in_rotation`.
    total : float or None
        Error of the moments on all bodies together.
    """

    forces: list[float]
    moments: list[float] | None
    total: float | None


def body_equilibrium(
    system: System, contact: ContactState, supports: SupportForces
) -> BodyEquilibrium:
    """Equilibrium of forces and moments of each body. Every rank calls."""
    shifts = [work_of(system, contact, supports, m.motion) for m in _across(system)]
    whole = max(work.scale for work in shifts)
    scales = np.max([work.scales for work in shifts], axis=0)
    scales = np.maximum(scales, _ROUNDING / ALLOWED * whole)
    forces = np.max([np.abs(work.residual) for work in shifts], axis=0)
    errors = [relative(e, s) for e, s in zip(forces, scales, strict=True)]
    if system.model.kinematics == "axisymmetric" or not _exact_in_rotation(system):
        return BodyEquilibrium(errors, None, None)
    middle = np.average(system.contacts.points, axis=0, weights=system.weights)
    axes = np.eye(3) if len(middle) == 3 else np.eye(3)[2:]
    turns = [work_of(system, contact, supports, rotation(axis, middle)) for axis in axes]
    found, sizes = np.array([work.residual for work in turns]), _sizes(system, supports, middle)
    pairs = zip(np.abs(found).max(axis=0), scales * sizes, strict=True)
    total = relative(float(np.abs(found.sum(axis=1)).max()), whole * sizes.max())
    return BodyEquilibrium(errors, [relative(e, s) for e, s in pairs], total)


def _sizes(system: System, supports: SupportForces, middle: np.ndarray) -> np.ndarray:
    """Largest distance of a node of each body from a point, shape (n_bodies,) [m]."""
    distances = np.linalg.norm(system.elastic.nodes() - middle, axis=1)
    own = [float(distances[mask].max(initial=0.0)) for mask in supports.owned]
    return np.max(system.comm.allgather(own), axis=0)


def work_of(
    system: System, contact: ContactState, supports: SupportForces, motion: RigidMotion
) -> Work:
    """Work of a rigid motion of each body against its forces. Every rank calls."""
    moved = motion.at(system.elastic.nodes())
    work = (supports.nodal * moved).sum(axis=1)
    each = work, np.abs(work), np.abs(supports.strained * moved).sum(axis=1)
    sums = np.array([[values[own].sum() for own in supports.owned] for values in each])
    held, borne, thermal = sum_over_ranks(system.comm, sums)
    given = system.dead_resultant(motion)
    found, carried = _borne_by_bodies(system, contact, motion)
    return Work(held, held - (found - given), borne, thermal, carried, np.abs(given))


def _with_rotations(system: System, contact: ContactState) -> list[tuple[RigidMode, float | None]]:
    """Rigid modes of the holders that the elements represent without strain, with their loads.

    Loads are the present ones; None for given motions, and where friction sticks.
    """
    exact = _exact_in_rotation(system)
    present = iter(contact.conditions.load - system.holder.dead)
    loads = [None if mode.load is None else next(present) for mode in system.holder.rigid_modes]
    return [
        (mode, load if contact.shear is None else None)
        for mode, load in zip(system.holder.rigid_modes, loads, strict=True)
        if exact or not mode.motion.rotation.any()
    ]


def _exact_in_rotation(system: System) -> bool:
    """True if the elements represent rigid rotations without strain.

    Rotations are linear in the coordinates: in cells with a geometry of higher degree than the
    displacement they cause small strains, and moments balance only within the discretisation error.
    """
    degree = system.model.discretisation.degree
    return all(coordinate_element(body.mesh).degree <= degree for body in system.bodies.each)


def _borne_by_bodies(
    system: System, contact: ContactState, motion: RigidMotion
) -> tuple[np.ndarray, np.ndarray]:
    """Work of a motion of each body against the contact, and sum of magnitudes, (n_bodies,)."""
    contacts, traction = system.contacts, contact.traction(system)
    result, magnitudes = np.zeros((2, len(system.model.bodies)))
    for body in range(len(result)):
        for side, points in contacts.of_body(body):
            at = (contacts.on_body_1, contacts.on_body_2)[side][points]
            work = contacts.weights[points] * np.einsum("ni,ni->n", motion.at(at), traction[points])
            result[body] += (1.0, -1.0)[side] * work.sum()
            magnitudes[body] += np.abs(work).sum()
    return result, magnitudes


def _across(system: System) -> list[RigidMode]:
    """Translations along the axes without a load, balanced independently of the holder."""
    gdim = system.contacts.points.shape[1]
    axes = [(0.0, 1.0)] if system.model.kinematics == "axisymmetric" else np.eye(gdim)
    return [RigidMode(translation(axis), amplitude=0.0) for axis in axes]


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
