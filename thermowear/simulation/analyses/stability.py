"""Thermoelastic stability: critical speeds and growth rates, with and without wear."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...errors import ComputationError
from ...results import Modes, Result
from ..results.recording import Snapshot
from ..runtime.observer import Observer
from ..system.system import System
from .perturbation import PerturbationMode, PerturbedContact

_SHOWN = 4
"""Number of static modes in the results."""


def stability(
    system: System, base: tuple[Snapshot, Result], observer: Observer
) -> tuple[Snapshot, Result]:
    """Thermoelastic stability analysis of a contact. Every rank calls.

    Parameters
    ----------
    system : System
        System with a thermal model.
    base : tuple of Snapshot and Result
        State and result of the unperturbed contact.
    observer : Observer

    Raises
    ------
    ComputationError
        If a body convects heat and the heat capacity of a body is not known.
    """
    end, unperturbed = base
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
    summary = unperturbed.summary | extra
    return end, replace(unperturbed, summary=summary, modes=_table(system, modes + static))


def _static(contact: PerturbedContact) -> list[PerturbationMode]:
    """First static modes."""
    found = contact.static
    pairs = zip(found.factors[:_SHOWN], found.shapes.T, strict=False)
    return [PerturbationMode(float(factor), 0j, shape) for factor, shape in pairs]


def _in_time(system: System, contact: PerturbedContact) -> tuple[dict, list[PerturbationMode]]:
    """Summary entries of growth rates and critical speeds, and the modes to tabulate."""
    critical, unworn = contact.onset(False), contact.fastest(False)
    onset, fastest, worn = critical, unworn, None
    if system.laws:
        onset = worn = contact.onset(True)
        fastest = contact.fastest(True)
    modes = [fastest] if fastest.rate.real > 0 else []
    if onset is not None and onset.rate.imag > 0:
        modes.append(onset)
    return _keys(system, critical, worn, fastest, unworn), modes


def _keys(
    system: System,
    critical: PerturbationMode | None,
    with_wear: PerturbationMode | None,
    fastest: PerturbationMode | None,
    unworn: PerturbationMode | None,
) -> dict:
    """Summary entries of a stability analysis."""
    motion = system.model.motion
    given = {
        "critical_speed_factor": 1.0,
        "critical_speed": motion.velocity,
        "critical_angular_velocity": motion.angular_velocity,
    }
    units = ("", "_m_per_s", "_rad_per_s")
    found: dict[str, float | None] = {}
    for which, onset in (("", critical), ("_with_wear", with_wear)):
        factor = onset.factor if onset else None
        for (name, value), unit in zip(given.items(), units, strict=True):
            known = None if factor is None or value is None else factor * abs(value)
            found[f"{name}{which}{unit}"] = known
        found[f"critical_frequency{which}_rad_per_s"] = onset.rate.imag if onset else None
    for which, mode in (("", fastest), ("_without_wear", unworn)):
        found[f"growth_rate{which}_per_s"] = mode.rate.real if mode else None
        found[f"growth_frequency{which}_rad_per_s"] = mode.rate.imag if mode else None
    return found


def _table(system: System, modes: list[PerturbationMode]) -> Modes:
    """Table of mode pressures at the contact points, each normalised to a largest value of 1."""
    points, s = system.pairing.points, system.pairing.position
    places = [*np.pad(points, ((0, 0), (0, 3 - points.shape[1]))).T, s]
    tables = [np.zeros((10, 0))]
    for number, mode in enumerate(modes, 1):
        p = system.basis @ mode.shape
        p = p / p[np.argmax(np.abs(p))] + 0j
        values = (number, mode.factor, mode.rate.real, mode.rate.imag)
        constants = [np.full(len(p), value) for value in values]
        tables.append(np.array([*constants, *places, p.real, p.imag]))
    return Modes(*np.hstack(tables))
