"""Fretting: sticking and slipping under a history of loads."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..case.analyses import Fretting
from ..case.schema import Case
from ..contact.loads import Loads
from ..contact.stick_slip import StickSlipState, follow
from ..contact.tangential import FrictionalContact, condense_tangential
from ..errors import ComputationError
from ..laws.motions import translation
from .interrupt import StopRequest
from .observer import Observer
from .outcome import Outcome
from .recording import interface_at
from .result import FrictionHistory, FrictionInterface, Interface, LoadRow
from .system import System

_SLIDES = 1 - 1e-6  # of friction's limit
_ACROSS = (1.0, 0.0)


def fretting(system: System, observer: Observer) -> Outcome:
    """Follow the history of loads. What was computed before an error or Ctrl-C is kept."""
    translations = [np.array(system.case.geometry.press_direction)]
    history = system.case.load.history
    if history is not None and history.tangential:
        translations.append(np.array(_ACROSS))
    with system.phases("condense elasticity"):
        contact = condense_tangential(
            system.elastic, system.pairing, system.basis, np.array(translations)
        )
    rows: list[LoadRow] = []
    outputs: dict[float, Interface] = {}
    frictions: dict[float, FrictionInterface] = {}
    last: StickSlipState | None = None
    stopped: BaseException | None = None
    with system.phases("load steps"), StopRequest() as stop:
        try:
            for time, is_output, state in _instants(system.case, contact):
                last = state
                rows.append(_row(system, time, state))
                observer.load_step(rows[-1])
                if is_output:
                    with system.phases("output"):
                        frictions[time] = _friction(system, state)
                        outputs[time] = _at(system, state, translations)[1]
                        observer.output(time, outputs[time], frictions[time])
                if stop.agreed(system.comm):
                    stopped = KeyboardInterrupt()
                    break
        except ComputationError as reason:
            stopped = reason
    if last is None:
        raise stopped or ComputationError("fretting: no increment was made")
    with system.phases("bodies"):
        bodies, interface = _at(system, last, translations)
    return Outcome(
        pressure=interface.pressure,
        motion=translation(last.motion @ np.array(translations)),
        state=bodies,
        interface=interface,
        extra=_extra(rows),
        history=[],
        outputs=outputs,
        friction=FrictionHistory(rows, _friction(system, last), frictions),
        stopped=stopped,
    )


def _instants(
    case: Case, contact: FrictionalContact
) -> Iterator[tuple[float, bool, StickSlipState]]:
    """Time of each increment, whether it is an output time, and the state there."""
    settings, history = case.analysis, case.load.history
    assert isinstance(settings, Fretting)
    assert history is not None  # the case has been checked
    corners = sorted({*history.time, *settings.output_times})
    loads = [_loads(case, time) for time in corners]
    starts = [corners[0], *corners[:-1]]  # the first corner is loaded at its own time
    states = follow(contact, case.contact.friction, loads, settings.increments)
    for start, end in zip(starts, corners, strict=True):
        for step in range(1, settings.increments + 1):
            last = step == settings.increments
            time = end if last else start + (end - start) * step / settings.increments
            yield time, last and end in settings.output_times, next(states)


def _loads(case: Case, time: float) -> Loads:
    """Loads at an instant [s]."""
    history = case.load.history
    assert history is not None
    given = history.at(time)
    if "force" not in given and "approach" not in given:
        return Loads(normal_force=case.force(), approach=case.approach(), **given)
    return Loads(normal_force=given.pop("force", None), **given)


def _row(system: System, time: float, state: StickSlipState) -> LoadRow:
    w = system.weights
    pressure = system.basis @ state.pressure
    sticking = _sticking(system, state)
    forces, motions = (np.append(v, [0.0, 0.0]) for v in (state.force, state.motion))
    return LoadRow(
        time=time,
        normal_force=float(forces[0]),
        approach=float(motions[0]),
        tangential_force=float(forces[1]),
        tangential_displacement=float(motions[1]),
        max_pressure=float(pressure.max()),
        contact_area=float(w[pressure > 0].sum()),
        stick_area=float(w[sticking].sum()),
        dissipated=float(w @ state.dissipated),
        iterations=state.iterations,
    )


def _sticking(system: System, state: StickSlipState) -> np.ndarray:
    """Points whose shear is below friction's limit, shape (n,)."""
    pressure, shear = system.basis @ state.pressure, system.basis @ state.shear[:, 0]
    return np.abs(shear) < _SLIDES * system.friction * pressure


def _friction(system: System, state: StickSlipState) -> FrictionInterface:
    points, pressure = system.pairing.points, system.basis @ state.pressure
    status = np.where(pressure > 0, np.where(_sticking(system, state), 1, 2), 0)
    return FrictionInterface(
        x=points[:, 0],
        y=points[:, 1],
        s=system.pairing.position,
        weight=system.weights,
        pressure=pressure,
        shear=system.basis @ state.shear[:, 0],
        slip=state.point_slip[:, 0],
        dissipated=state.dissipated,
        status=status,
    )


def _at(system: System, state: StickSlipState, translations):
    """Bodies and interface in a state."""
    pressure, shear = system.basis @ state.pressure, system.basis @ state.shear[:, 0]
    still = np.zeros((2, len(pressure)))
    moved = translation(state.motion @ np.array(translations))
    return interface_at(system, pressure, moved, still, shear)


def _extra(rows: list[LoadRow]) -> dict:
    """What a fretting analysis adds to the summary."""
    last = rows[-1]
    return {
        "steps": len(rows),
        "time_s": last.time,
        "normal_force_N": last.normal_force,
        "friction_force_N": abs(last.tangential_force),
        "guide_force_N": None,
        "tangential_force_N": last.tangential_force,
        "tangential_displacement_m": last.tangential_displacement,
        "stick_area_m2": last.stick_area,
        "dissipated_energy_J": last.dissipated,
    }
