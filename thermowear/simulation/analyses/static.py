"""Static analyses: contact of the unworn faces, steady state of wear, thermoelastic stability."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...errors import ComputationError
from ...laws.principle.least_worn import least_worn
from ...laws.stability import Rate
from ...results import Modes, Result
from ..interface.body_state import body_state
from ..interface.condensed_method import CondensedMethod
from ..interface.interface_problem import InterfaceProblem, interface_problem
from ..interface.steady import steady_state
from ..results.recording import Snapshot, record, snapshot_at
from ..results.summary import conclude, merged
from ..runtime.observer import Observer
from ..system.system import System
from .growth_model import PerturbationMode
from .perturbation import PerturbedContact

_VELOCITIES = {
    "z": "rigid_wear_velocity_m_per_s",
    "x": "rigid_wear_velocity_x_m_per_s",
    "y": "rigid_wear_velocity_y_m_per_s",
    "rotation": "rigid_wear_rotation_rad_per_s",
    "rotation-x": "rigid_wear_rotation_x_rad_per_s",
    "rotation-y": "rigid_wear_rotation_y_rad_per_s",
}
_SHOWN = 4
"""Number of static modes in the results."""


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
    _require_positions(system, pressing)
    # holder position of least material removal for conforming faces
    opening = state.opening + system.softness * wear.pressure
    position = least_worn(system.holder.modes, opening, system.weights, pressing)
    height = system.holder.modes @ position - opening
    shape = np.full(len(height), np.nan)  # unknown where wear has unloaded the contact
    for own in system.contacts.ranges:
        shape[own] = np.fmax.reduce(np.where(pressing, height, np.nan)[own]) - height[own]
    end = record(
        system,
        contact,
        system.motions(system.holder.amplitudes(position)),
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


def stability(system: System, observer: Observer) -> tuple[Snapshot, Result]:
    """Thermoelastic stability of the steady state, or of the cold unworn contact if there is none.

    Every rank calls.

    Raises
    ------
    ComputationError
        If a body convects heat and the heat capacity of a body is not known.
    """
    free = system.holder.free
    if system.laws and len(free) and free.all():
        end, unperturbed = steady(system, observer)
    else:
        end, unperturbed = unworn(InterfaceProblem(system, CondensedMethod(system), None))
    contact = PerturbedContact(system, end.contact.pressure, end.contact.conditions)
    if not contact.has_capacity:
        if contact.has_advection:
            raise ComputationError(
                "stability: a body carries heat along, so disturbances move; that needs density "
                "and specific_heat of all bodies"
            )
        observer.note(
            "without density and specific_heat of all bodies only disturbances that stay at "
            "their critical speed are found, and no rates; others may swing, and grow before"
        )
    with system.phases("stability"):
        static = [] if contact.has_advection else _static(contact)
        if contact.has_capacity:
            extra, modes = _in_time(system, contact)
        else:
            extra, modes = _keys(system, static[0] if static else None, None, None, None), []
    extra["static_speed_factors"] = [mode.factor for mode in static]
    summary = merged(unperturbed.summary, extra)
    return end, replace(unperturbed, summary=summary, modes=_table(system, modes + static))


def _static(contact: PerturbedContact) -> list[PerturbationMode]:
    """First static modes."""
    found = contact.static
    pairs = zip(found.factors[:_SHOWN], found.shapes.T, strict=False)
    return [PerturbationMode(float(factor), Rate(0j, shape)) for factor, shape in pairs]


def _in_time(system: System, contact: PerturbedContact) -> tuple[dict, list[PerturbationMode]]:
    """Summary entries of growth rates and critical speeds, and the modes to tabulate."""
    critical, unworn = contact.onset(False), contact.fastest(False)
    onset, fastest, worn = critical, unworn, None
    if system.laws:
        onset = worn = contact.onset(True)
        fastest = contact.fastest(True)
    modes = [fastest] if fastest.rate.value.real > 0 else []
    if onset is not None and onset.rate.value.imag > 0:
        modes.append(onset)
    return _keys(system, critical, worn, fastest, unworn), modes


def _keys(
    system: System,
    critical: PerturbationMode | None,
    with_wear: PerturbationMode | None,
    fastest: PerturbationMode | None,
    unworn: PerturbationMode | None,
) -> dict:
    """Summary entries of a stability analysis; critical speeds of several bodies by contact."""
    found: dict[str, Any] = {}
    speeds: dict[str, dict[str, float | None]] = {}
    for which, onset in (("", critical), ("_with_wear", with_wear)):
        factor = onset.factor if onset else None
        found[f"critical_speed_factor{which}"] = factor
        found[f"critical_frequency{which}_rad_per_s"] = onset.rate.value.imag if onset else None
        for one in system.model.interfaces:
            own = speeds.setdefault(one.name, {})
            for name, value in (
                (f"speed{which}_m_per_s", one.motion.velocity),
                (f"angular_velocity{which}_rad_per_s", one.motion.angular_velocity),
            ):
                known = None if factor is None or value is None else factor * abs(value)
                own[f"critical_{name}"] = known
    by_contact: dict[str, Any] = {"contacts": speeds}
    found |= speeds[""] if system.model.is_pair else by_contact
    for which, mode in (("", fastest), ("_without_wear", unworn)):
        found[f"growth_rate{which}_per_s"] = mode.rate.value.real if mode else None
        found[f"growth_frequency{which}_rad_per_s"] = mode.rate.value.imag if mode else None
    return found


def _table(system: System, modes: list[PerturbationMode]) -> Modes:
    """Table of mode pressures at the contact points, each normalised to a largest value of 1."""
    points, s = system.contacts.points, system.contacts.position
    places = [*np.pad(points, ((0, 0), (0, 3 - points.shape[1]))).T, s]
    tables = [np.zeros((10, 0))]
    for number, mode in enumerate(modes, 1):
        p = system.basis @ mode.rate.shape
        p = p / p[np.argmax(np.abs(p))] + 0j
        values = (number, mode.factor, mode.rate.value.real, mode.rate.value.imag)
        constants = [np.full(len(p), value) for value in values]
        tables.append(np.array([*constants, *places, p.real, p.imag]))
    return Modes(*np.hstack(tables))
