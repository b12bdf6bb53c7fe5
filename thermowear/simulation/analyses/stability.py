"""Thermoelastic stability of the steady state, or of the cold contact: modes, and hot spots."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...errors import ComputationError
from ...laws.stability import Rate
from ...model.analyses import StabilityAnalysis, StaticAnalysis
from ...model.model import Model
from ...results import Modes, Result
from ..hot_spots.analysis import hot_spots
from ..interface.condensed_method import CondensedMethod
from ..interface.interface_problem import InterfaceProblem
from ..results.recording import Snapshot
from ..results.summary import merged
from ..runtime.observer import Observer
from ..system.system import System
from .growth_model import PerturbationMode
from .perturbation import PerturbedContact, static_factor
from .static import steady, unworn

_SHOWN = 4
"""Number of static modes in the results."""


def stability(
    system: System, analysis: StaticAnalysis, observer: Observer
) -> tuple[Snapshot, Result]:
    """Thermoelastic stability of the steady state, or of the cold unworn contact if there is none.

    Every rank calls.

    Raises
    ------
    ComputationError
        If a body convects heat and the heat capacity of a body is not known.
    """
    end, unperturbed = base_state(system, observer)
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
    found = replace(unperturbed, modes=_table(system, modes + static))
    if isinstance(analysis, StabilityAnalysis) and analysis.waves:
        with system.phases("hot spots"):
            more, spots = hot_spots(end, analysis, observer, base_state)
        extra, found = extra | more, replace(found, hot_spots=spots)
    return end, replace(found, summary=merged(unperturbed.summary, extra))


def base_state(system: System, observer: Observer) -> tuple[Snapshot, Result]:
    """Unperturbed state: the steady state of wear, or the contact of the unworn faces."""
    free = system.holder.free
    if system.laws and len(free) and free.all():
        return steady(system, observer)
    return unworn(InterfaceProblem(system, CondensedMethod(system), None))


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
    modes = [fastest] if fastest is not None and fastest.rate.value.real > 0 else []
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
    for which, onset in (("", critical), ("_with_wear", with_wear)):
        found[f"critical_frequency{which}_rad_per_s"] = onset.rate.value.imag if onset else None
        factor = onset.factor if onset else None
        found = merged(found, critical_speeds(system.model, factor, which))
    for which, mode in (("", fastest), ("_without_wear", unworn)):
        found[f"growth_rate{which}_per_s"] = mode.rate.value.real if mode else None
        found[f"growth_frequency{which}_rad_per_s"] = mode.rate.value.imag if mode else None
    return found


def critical_speeds(model: Model, factor: float | None, which: str = "") -> dict[str, Any]:
    """Summary entries of a critical speed factor; speeds of several bodies by contact."""
    speeds: dict[str, Any] = {}
    for one in model.interfaces:
        given = one.motion.velocity, one.motion.angular_velocity
        known = [None if factor is None or v is None else factor * abs(v) for v in given]
        names = f"critical_speed{which}_m_per_s", f"critical_angular_velocity{which}_rad_per_s"
        speeds[one.name] = dict(zip(names, known, strict=True))
    by_contact = speeds[""] if model.is_pair else {"contacts": speeds}
    return {f"critical_speed_factor{which}": factor, **by_contact}


def hot_state(end: Snapshot, result: Result, observer: Observer) -> Result:
    """Result with the critical speed of its last state; notes an unstable one. Every rank calls.

    Of states in steady temperatures.
    """
    system, heat = end.system, end.system.model.heat
    if heat is None or heat.transient or result.stopped is not None:
        return result
    with system.phases("stability"):
        factor = static_factor(system, end.contact)
    if factor is None:
        return result
    if factor < 1.0:
        observer.note(
            f"the hot state is unstable without wear, at {1 / factor:.3g} times its critical "
            "speed: uneven pressures grow, unless wear evens them out (a stability analysis "
            "tells); hot spots along the sliding were not examined"
        )
    extra = critical_speeds(system.model, factor)
    return replace(result, summary=merged(result.summary, extra))


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
