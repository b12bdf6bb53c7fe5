"""State of the bodies under a known contact pressure: temperatures, displacements, balances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...balances import ALLOWED, relative, require
from ...compat import coordinate_element
from ...contact.operators.rigid_motion import RigidMode
from ...contact.operators.tangential import tangents
from ...contact.operators.traces import vector_trace
from ...contact.search.pairing import PairedFace
from ...laws.motions import translation
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
        return traction - self.shear[:, None] * tangents(system.pairing.normals)[0]


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
    """Fields of both bodies and their effect on the interface.

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
        pairing = system.pairing
        along = vector_trace(system.elastic.spaces, pairing, -tangents(pairing.normals)[0])
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
    """Relative error between support reactions and the forces of holder and contact.

    Along each rigid mode the reaction on body 1 must equal the load of the holder, or the contact
    force where the motion is given, and the support of body 2 must balance the contact; across
    them the guides do. Moments of the contact act on each body at its own points. Relative to the
    sum of the magnitudes, for translations of all forces. Where no force acts, as on hot bodies
    apart, reactions are the rounding of the thermal forces ``strained`` (n_owned,), without their
    part that grows beyond bounds towards ν = 0.5.
    """
    rigid_modes = [*_with_rotations(system), *_across(system)]
    nodes = system.elastic.nodes()
    reactions = system.elastic.reactions(displacement, loads).reshape(nodes.shape)
    upper = system.elastic.owned_by(*system.model.bodies[0].parts)
    carried, carried_by_2 = (
        _work(system, contact, rigid_modes, side) for side in system.pairing.sides
    )
    errors, scales = np.zeros(len(rigid_modes)), np.zeros(len(rigid_modes))
    strained = system.elastic.compressibility() * strained.reshape(nodes.shape)
    pressed = _part(contact.conditions.load - system.holder.dead, system.holder.load)
    for k, (mode, share, other) in enumerate(zip(rigid_modes, carried, carried_by_2, strict=True)):
        moved = mode.motion.at(nodes)
        work = (reactions * moved).sum(axis=1)
        magnitudes = np.abs(work).sum(), np.abs(strained * moved).sum()
        parts = np.array([work[upper].sum(), work[~upper].sum(), *magnitudes])
        held, supported, borne, thermal = sum_over_ranks(system.comm, parts)
        given = system.dead_resultant(mode.motion)
        found = share.sum()
        # the load may be below the maximum of its history
        expected = (
            found - given[0]
            if mode.load is None or contact.shear is not None
            else pressed * mode.load
        )
        errors[k] = np.maximum(abs(held - expected), abs(supported + given[1] + other.sum()))
        loaded = np.abs(share).sum() + np.abs(given).sum()
        scales[k] = max(loaded, borne, _ROUNDING / ALLOWED * thermal)
    shifts = np.array([not mode.motion.rotation.any() for mode in rigid_modes])
    scales[shifts] = scales[shifts].max()
    return max(relative(e, s) for e, s in zip(errors, scales, strict=True))


def _with_rotations(system: System) -> list[RigidMode]:
    """Rigid modes of the holder that the elements represent without strain.

    Rotations are linear in the coordinates: in cells with a geometry of higher degree than the
    displacement they cause small strains, and moments balance only within the discretisation error.
    """
    degree = system.model.discretisation.degree
    curved = any(coordinate_element(body.mesh).degree > degree for body in system.bodies.each)
    return [d for d in system.holder.rigid_modes if not (curved and d.motion.rotation.any())]


def _work(system: System, contact: ContactState, rigid_modes, side: PairedFace) -> np.ndarray:
    """Work of the contact traction on motions of a body at the points of its face, (k, n)."""
    points = side.face.points(side.facet, side.t)
    moved = np.array([mode.motion.at(points) for mode in rigid_modes])
    return system.weights * np.einsum("kni,ni->kn", moved, contact.traction(system))


def _across(system: System) -> list[RigidMode]:
    """Translations along the axes without a load, balanced independently of the holder."""
    gdim = system.pairing.points.shape[1]
    axes = [system.load_direction] if system.model.kinematics == "axisymmetric" else np.eye(gdim)
    return [RigidMode(translation(axis), amplitude=0.0) for axis in axes]


def _part(load: np.ndarray, largest: np.ndarray) -> float:
    """Fraction of the largest loads that is applied."""
    size = float(largest @ largest)
    return float(load @ largest) / size if size > 0 else 1.0
