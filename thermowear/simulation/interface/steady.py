"""Steady state by the principle of minimum wear dissipation power."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...contact.operators.pressure import dense, scaled
from ...contact.solvers.signorini import NoEquilibrium, solve_contact
from ...errors import ComputationError
from ...laws.principle.steady import NotCarried, SteadyWear, least_worn, steady_pressure
from ..heat.friction_heat import friction_heat
from ..system.conditions import ConditionModel, InterfaceConditions, parted_by_fluid
from ..system.system import System
from .body_state import ContactState, opening_by
from .fixed_point import Trial, self_consistent
from .growing_edge import GrowingEdge
from .sdirk import InterfaceState

_NONE = (
    "no steady state found: the iteration for state-dependent friction, wear or conductance did "
    "not converge; reduce the speed or the load, or follow the running-in in time"
)


@dataclass(frozen=True)
class SteadyState:
    """Steady state of a system.

    Attributes
    ----------
    wear : SteadyWear
        Of the sliding contacts.
    contact : ContactState
    resting : ndarray, shape (k,)
        Free motions of the holders in the equilibrium of the contacts at rest [m or rad].
    """

    wear: SteadyWear
    contact: ContactState
    resting: np.ndarray

    def position(self, system: System, opening: np.ndarray) -> np.ndarray:
        """Free motions (k,) of the holders of the least material removal for conforming faces.

        Contacts at rest keep their equilibrium.

        Parameters
        ----------
        system : System
        opening : ndarray, shape (n,)
            Change of the gap by load and heat [m].
        """
        modes, (worn, _) = system.holder.modes, system.divided_motions
        pressing, left = self.wear.pressure > 0, opening - modes @ self.resting
        return self.resting + worn @ least_worn(modes @ worn, left, system.weights, pressing)


def steady_state(system: System) -> SteadyState:
    """Steady pressure, wear rates and rigid-body wear velocity of a system. Every rank calls.

    State-dependent friction, wear or conductance are resolved by fixed-point iteration. Faces with
    layers have lost them: wear that goes on for ever ends in the substrate. The principle governs
    the contacts that slide; those at rest are in elastic contact.

    Raises
    ------
    ComputationError
        If there is no steady state, or the fixed-point iteration does not converge.
    """
    system = system.worn_through()
    heat = friction_heat(system)
    uniform = np.full(len(system.weights), system.mean_pressure)
    zeros = np.zeros((len(system.laws), len(uniform)))
    start = Trial(uniform, None if heat is None else heat.steps.steady.baseline.unheated, zeros)

    wear: SteadyWear | None = None
    motion = np.zeros(system.holder.modes.shape[1])

    def respond(conditions: InterfaceConditions) -> Trial:
        nonlocal wear, motion
        wear = principle(
            system.with_friction(conditions.friction),
            conditions.load,
            speed=conditions.speed,
            factors=conditions.wear,
            temperature=conditions.temperature,
            friction=conditions.friction,
        )
        pressure = wear.pressure
        if system.at_rest.any():
            temperatures = None if heat is None else heat.steady(conditions, pressure)
            carried = ContactState(pressure, conditions, temperatures)
            borne, motion = _at_rest(system.with_friction(conditions.friction), carried)
            pressure = pressure + borne
        faces = None if heat is None else heat.steps.steady.faces(conditions, pressure)
        return Trial(pressure, faces, zeros)

    conditions, found = self_consistent(ConditionModel(system), 0.0, start, respond, _NONE)
    temperatures = None if heat is None else heat.steady(conditions, found.pressure)
    assert wear is not None
    return SteadyState(wear, ContactState(found.pressure, conditions, temperatures), motion)


def principle(system: System, load: np.ndarray, speed: np.ndarray, **conditions: Any) -> SteadyWear:
    """Solve the principle under a load on the holder and conditions as in `steady_pressure`.

    For the contacts that slide, and motions of the holders that contacts at rest admit.

    Raises
    ------
    ComputationError
        If there is no solution.
    """
    at_rest, (worn, _) = system.at_rest, system.divided_motions
    pairs = zip(system.model.interfaces, system.contacts.ranges, strict=True)
    stops = [one.path("motion") for one, points in pairs if not speed[points].all()]
    sliding = [one.path("motion") for one in system.model.interfaces if not one.motion.at_rest]
    if any(table in sliding for table in stops) or not sliding:
        raise ComputationError(
            f"{stops[0]}: no steady state: the sliding speed is 0 at some contact points"
        )
    if worn.shape[1] == 0:
        raise ComputationError(
            f"{stops[0]}: no steady state: this contact does not slide, and no holder moves as "
            "others wear without moving against it; give the worn body a holder, or glue the "
            "bodies"
        )
    modes, forces = (
        np.where(at_rest[:, None], 0.0, each @ worn)
        for each in (system.holder.modes, system.holder.force_modes)
    )
    try:
        found = steady_pressure(
            weights=np.where(at_rest, 0.0, system.weights),
            normal_modes=modes,
            force_modes=forces,
            load=worn.T @ load,
            laws=list(system.laws.values()),
            speed=np.where(at_rest, 1.0, speed),  # of any size: without motions nothing presses
            spread=list(system.spreads.values()),
            **conditions,
        )
    except NotCarried as error:
        raise parted_by_fluid(system, load) or error from None
    return replace(found, velocity=worn @ found.velocity)


def _at_rest(system: System, carried: ContactState) -> tuple[np.ndarray, np.ndarray]:
    """Pressure (n,) of contacts at rest, and motions (k,) of the holders that press them.

    Signorini's conditions between bodies under the loads of the sliding contacts.
    """
    contact, (_, pressing) = system.contact, system.divided_motions
    own = np.flatnonzero(abs(contact.basis).T @ system.at_rest)
    opening = opening_by(system, carried) + system.contacts.gap - system.holder.imposed
    soft = dense(contact.weighted.T @ scaled(system.softness, contact.basis))
    taken = system.holder.force_modes.T @ (system.weights * carried.pressure)
    try:
        found = solve_contact(
            (contact.compliance + soft)[np.ix_(own, own)],
            contact.weak(opening)[own],
            contact.modes[own] @ pressing,
            pressing.T @ (carried.conditions.load - taken),
        )
    except NoEquilibrium as error:
        resting = [one.table for one in system.model.interfaces if one.motion.at_rest]
        raise ComputationError(
            f"no steady state: {', '.join(resting)} at rest: {error}; change the forces of the "
            "holders"
        ) from None
    return contact.basis[:, own] @ found.coefficients, pressing @ found.motion


@dataclass(frozen=True)
class SteadyLimit:
    """Limit of a running-in in the pressure space of its contact.

    Attributes
    ----------
    steady : SteadyState
    edge : ndarray of bool or None, shape (n,)
        Points with pointwise contact of the state that approaches it.
    points : ndarray of bool or None, shape (n,)
        Those that it keeps.
    pressure : ndarray, shape (n,) [Pa]
    """

    steady: SteadyState
    edge: np.ndarray | None
    points: np.ndarray | None
    pressure: np.ndarray


def steady_limit(
    edge: GrowingEdge, steady: SteadyState, state: InterfaceState, last: SteadyLimit | None
) -> SteadyLimit:
    """Limit that a state approaches.

    Points that an edge of the wear has left behind keep pointwise contact where the pressure space
    is too coarse for the steady pressure. The limit is then that of the space with these points.

    Parameters
    ----------
    edge : GrowingEdge
    steady : SteadyState
    state : InterfaceState
    last : SteadyLimit or None
        An earlier limit, for its pressure if the space is the same.
    """
    points = state.pointwise
    if points is not None and edge.partial_zones(state.worn):
        points = None  # not yet the limit
    if last is not None and last.steady is steady and _same(last.points, points):
        return replace(last, edge=state.pointwise)
    conditions = steady.contact.conditions
    rates = edge.wear.final_rates(conditions)
    pressure = edge.method.steady(steady.contact.pressure, rates, conditions, points)
    return SteadyLimit(steady, state.pointwise, points, pressure)


def _same(one: np.ndarray | None, other: np.ndarray | None) -> bool:
    return one is other or (one is not None and other is not None and np.array_equal(one, other))
