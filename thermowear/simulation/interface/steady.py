"""Steady state by the principle of minimum wear dissipation power."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...laws.principle.steady import NotCarried, SteadyWear, steady_pressure
from ..heat.friction_heat import friction_heat
from ..system.conditions import ConditionModel, InterfaceConditions
from ..system.fluid import parted_by_fluid
from ..system.system import System
from .equilibrium import ContactState
from .fixed_point import Trial, self_consistent

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
    contact : ContactState
    """

    wear: SteadyWear
    contact: ContactState


def steady_state(system: System) -> SteadyState:
    """Steady pressure, wear rates and rigid-body wear velocity of a system. Every rank calls.

    State-dependent friction, wear or conductance are resolved by fixed-point iteration. Faces with
    layers have lost them: wear that goes on for ever ends in the substrate.

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

    def respond(conditions: InterfaceConditions) -> Trial:
        nonlocal wear
        wear = principle(
            system.with_friction(conditions.friction),
            conditions.load,
            speed=conditions.speed,
            factors=conditions.wear,
            temperature=conditions.temperature,
            friction=conditions.friction,
        )
        faces = None if heat is None else heat.steps.steady.faces(conditions, wear.pressure)
        return Trial(wear.pressure, faces, zeros)

    conditions, found = self_consistent(ConditionModel(system), 0.0, start, respond, _NONE)
    temperatures = None if heat is None else heat.steady(conditions, found.pressure)
    assert wear is not None
    return SteadyState(wear, ContactState(found.pressure, conditions, temperatures))


def principle(system: System, load: np.ndarray, **conditions) -> SteadyWear:
    """Solve the principle under a load on the holder and conditions as in `steady_pressure`."""
    try:
        return steady_pressure(
            weights=system.weights,
            normal_modes=system.holder.modes,
            force_modes=system.holder.force_modes,
            load=load,
            laws=list(system.laws.values()),
            spread=list(system.spreads.values()),
            **conditions,
        )
    except NotCarried as error:
        raise parted_by_fluid(system, load) or error from None
