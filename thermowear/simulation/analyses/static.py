"""Static analyses: contact of the unworn faces, and steady state of wear."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...errors import ComputationError
from ...results import Result
from ..interface.body_state import body_state
from ..interface.interface_problem import InterfaceProblem, interface_problem
from ..interface.steady import steady_state
from ..results.recording import Snapshot, record, snapshot_at
from ..results.summary import conclude
from ..runtime.observer import Observer
from ..system.system import System

_VELOCITIES = {
    "z": "rigid_wear_velocity_m_per_s",
    "x": "rigid_wear_velocity_x_m_per_s",
    "y": "rigid_wear_velocity_y_m_per_s",
    "rotation": "rigid_wear_rotation_rad_per_s",
    "rotation-x": "rigid_wear_rotation_x_rad_per_s",
    "rotation-y": "rigid_wear_rotation_y_rad_per_s",
}


def initial(system: System, observer: Observer) -> tuple[Snapshot, Result]:
    """Contact of the unworn faces."""
    return unworn(interface_problem(system, observer.note))


def unworn(problem: InterfaceProblem) -> tuple[Snapshot, Result]:
    """Contact of the unworn faces, from a given interface problem."""
    phases = problem.system.phases
    with phases("contact"):
        found = problem.unworn()
    with phases("bodies"):
        return conclude(snapshot_at(problem, found, 0.0), {"steps": 0})


def steady(system: System, observer: Observer) -> tuple[Snapshot, Result]:
    """Steady state of wear, with faces worn to conformity."""
    with system.phases("steady principle"):
        found = steady_state(system)
    with system.phases("bodies"):
        contact = found.contact
        state = body_state(system, contact)
    wear = found.wear
    pressing = contact.pressure > 0
    _require_positions(system, pressing)
    opening = state.opening + system.softness * contact.pressure
    position = found.position(system, opening)
    height = system.holder.modes @ position - opening
    shape = np.full(len(height), np.nan)  # unknown where wear has unloaded the contact
    for own in system.contacts.ranges:
        shape[own] = np.fmax.reduce(np.where(pressing, height, np.nan)[own]) - height[own]
    gap, at_rest = np.where(pressing, 0.0, np.nan), system.at_rest
    shape[at_rest] = 0.0
    gap[at_rest] = (system.contacts.gap - system.holder.imposed - height)[at_rest]
    end = record(
        system,
        contact,
        system.motions(system.holder.amplitudes(position)),
        state,
        gap=gap,
        shape=shape,
        worn=np.zeros((2, len(shape))),
    )
    extra = {
        "steps": 0,
        **wear_velocity(system, wear.velocity),
        "wear_dissipation_W": wear.dissipation,
    }
    return conclude(replace(end, wear_velocity=wear.velocity), extra)


def _require_positions(system: System, pressing: np.ndarray) -> None:
    """Reject holders whose free motions close the gap at no point that presses (n,).

    Raises
    ------
    ComputationError
    """
    idle = ~np.any(system.holder.modes[pressing] != 0.0, axis=0)
    if idle.any():
        names = np.array([f"{h.name} ({name})" for h in system.model.holders for name in h.free])
        raise ComputationError(
            f"no steady position of the holders {', '.join(names[system.holder.free][idle])}: "
            "their contacts carry nothing; give them a force, or fix them (free = [])"
        )


def wear_velocity(system: System, velocity: np.ndarray | None) -> dict[str, Any]:
    """Rigid-body wear velocities of the free modes of the holders, by summary key [m/s, rad/s]."""
    found: dict[str, Any] = {}
    amounts = np.zeros(len(system.holder.rigid_modes))  # those of given motions
    if velocity is not None:
        amounts[system.holder.free] = velocity
    for holder, modes in zip(system.model.holders, system.modes_of_holders, strict=True):
        own: dict[str, float | None] = {_VELOCITIES["z"]: None}
        found[holder.name] = own
        if velocity is not None:
            pairs = zip(holder.free, amounts[modes], strict=True)
            own |= {_VELOCITIES[name]: float(value) for name, value in pairs}
    return found[system.model.holder.name] if system.model.is_pair else {"holders": found}
