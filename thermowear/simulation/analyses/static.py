"""Static analyses: contact of the unworn faces, and the steady state of wear."""

from __future__ import annotations

import numpy as np

from ...laws.motions import combined
from ...laws.principle.least_worn import least_worn
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
    pressing = wear.pressure > 0
    # holder position of least material removal for conforming faces
    opening = state.opening + system.softness * wear.pressure
    position = least_worn(system.holder.modes, opening, system.weights, pressing)
    height = system.holder.modes @ position - opening
    shape = height[pressing].max() - height
    end = record(
        system,
        contact,
        combined(system.holder.motions, position),
        state,
        gap=np.where(pressing, 0.0, np.nan),
        shape=shape,
        worn=np.zeros((2, len(shape))),
    )
    extra = {
        "steps": 0,
        **wear_velocity(system, wear.velocity),
        "wear_dissipation_W": wear.dissipation,
    }
    return conclude(end, extra)


def wear_velocity(system: System, velocity: np.ndarray | None) -> dict[str, float | None]:
    """Rigid-body wear velocities of the free holder modes, by summary key [m/s, rad/s]."""
    found: dict[str, float | None] = {_VELOCITIES["z"]: None}
    if velocity is not None:
        names = system.model.holder.free
        found |= {_VELOCITIES[k]: float(v) for k, v in zip(names, velocity, strict=True)}
    return found
