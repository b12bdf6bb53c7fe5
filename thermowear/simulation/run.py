"""From a case to a result: the analyses, told as a story."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..case.analyses import Transient
from ..case.schema import Case
from ..errors import ComputationError
from ..laws.motions import combined
from .condensed_method import CondensedMethod
from .fields import sample
from .fretting import fretting
from .interface_problem import InterfaceProblem
from .observer import Observer
from .outcome import Outcome
from .phases import Phases
from .preparation import interface_problem, prepare
from .reciprocating import reciprocating
from .recording import interface_at, profile, record
from .result import BodyFields, Result
from .running_in import RunningIn, running_in
from .saving import Saved
from .stability import stability
from .state import body_state
from .steady import SteadyState, least_worn, steady_state
from .summary import summarise
from .system import System

_UNPAIRED = 1e-6
_VELOCITIES = {
    "z": "rigid_wear_velocity_m_per_s",
    "x": "rigid_wear_velocity_x_m_per_s",
    "y": "rigid_wear_velocity_y_m_per_s",
    "rotation": "rigid_wear_rotation_rad_per_s",
    "rotation-x": "rigid_wear_rotation_x_rad_per_s",
    "rotation-y": "rigid_wear_rotation_y_rad_per_s",
}


def run(
    case: Case,
    comm=None,
    observer: Observer | None = None,
    phases: Phases | None = None,
    saved: Saved | None = None,
) -> Result:
    """Compute a case. Every rank calls.

    Parameters
    ----------
    case : Case
    comm : mpi4py.MPI.Comm, optional
        All ranks by default.
    observer : Observer, optional
    phases : Phases, optional
        Clock that has been running already.
    saved : Saved, optional
        What `Observer.checkpoint` was told on this rank by an earlier run, to go on with; the
        result has the whole history, and the outputs from there on.

    Returns
    -------
    Result

    Raises
    ------
    ComputationError
        If there is no answer at all; a transient run that stops on its way is returned, with what
        stopped it.
    """
    if comm is None:
        from mpi4py import MPI

        comm = MPI.COMM_WORLD
    observer = observer or Observer()
    phases = phases or Phases(observer.phase)
    system = prepare(case, comm, phases)
    outcome = analyse(system, observer, saved)
    with phases("fields"):
        fields = sample(outcome.system or system, outcome.state, outcome.motion)
    return conclude(system, outcome, fields)


def analyse(system: System, observer: Observer, saved: Saved | None = None) -> Outcome:
    """The analysis that the case of a system asks for; what is odd about it is said.

    It begins, or goes on with what was saved of an analysis of the same system.

    Every rank calls.
    """
    if system.pairing.unpaired > _UNPAIRED:
        percent = 100 * system.pairing.unpaired
        observer.note(
            f"{percent:.2g} % of the contact face of body 1 has nothing opposite and "
            "stays out of the contact"
        )
    before = () if saved is None else (saved.of(system),)
    outcome = _ANALYSES[system.case.analysis.type](system, observer, *before)
    if _outgrown(outcome.system or system, outcome.contact.pressure):
        observer.note(
            "the contact reaches the end of the contact face, which was meshed for a smaller one; "
            "use contact.positioning = true, or a wider geometry.zone"
        )
    return outcome


def conclude(system: System, outcome: Outcome, fields: BodyFields | None) -> Result:
    """What a run returns."""
    system = outcome.system or system
    return Result(
        outcome.interface,
        profile(system, outcome.interface),
        summarise(system, outcome),
        outcome.history,
        outcome.outputs,
        fields,
        outcome.friction,
        outcome.track,
        outcome.stopped,
        outcome.heat,
        outcome.modes,
    )


def _beyond(system: System) -> tuple[bool, bool]:
    """Whether the first and the last end of the face lie beyond where it was meshed to touch."""
    case, x = system.case, system.pairing.points[:, 0]
    zone = case.geometry.expected_zone(case.pressing())
    if zone is None:
        return False, False
    margin = 1e-6 * (zone[1] - zone[0])
    return bool(x[0] < zone[0] - margin), bool(x[-1] > zone[1] + margin)


def _outgrown(system: System, pressure: np.ndarray) -> bool:
    """Whether it presses at an end of the face that should lie beyond the contact."""
    ends = zip(_beyond(system), (0, -1), strict=True)
    return any(beyond and pressure[end] > 0 for beyond, end in ends)


def _problem(system: System, observer: Observer) -> InterfaceProblem:
    """The interface problem; what is odd about its settings is said."""
    problem = interface_problem(system)
    if problem.note is not None:
        observer.note(problem.note)
    return problem


def _initial(system: System, observer: Observer) -> Outcome:
    """Contact of the unworn faces."""
    return _unworn(system, _problem(system, observer))


def _unworn(system: System, problem: InterfaceProblem) -> Outcome:
    with system.phases("contact"):
        unworn = problem.unworn()
    with system.phases("bodies"):
        contact = problem.contact_state(unworn, 0.0)
        motion = combined(system.holder.motions, unworn.contact.motion)
        still = np.zeros((2, len(contact.pressure)))
        state, interface = interface_at(system, contact, motion, still)
    return Outcome(contact, motion, state, interface, {"steps": 0}, [], {})


def _steady(system: System, observer: Observer) -> Outcome:
    """The steady state; the faces are as if they had worn into each other."""
    with system.phases("steady principle"):
        found = steady_state(system)
    with system.phases("bodies"):
        contact = found.contact
        state = body_state(system, contact)
    steady = found.wear
    pressing = steady.pressure > 0
    # the holder stands where the unworn faces would lose just enough material to fit
    opening = state.opening + system.softness * steady.pressure
    amounts = least_worn(system.holder.modes, opening, system.weights, pressing)
    lost = system.holder.modes @ amounts - opening
    shape = lost[pressing].max() - lost
    interface = record(
        system,
        contact,
        state,
        gap=np.where(pressing, 0.0, np.nan),
        shape=shape,
        worn=np.zeros((2, len(shape))),
    )
    extra = {
        "steps": 0,
        **_wear_velocity(system, steady.velocity),
        "wear_dissipation_W": steady.dissipation,
    }
    motion = combined(system.holder.motions, amounts)
    return Outcome(contact, motion, state, interface, extra, [], {})


def _principle(system: System, settings: Transient) -> SteadyState | None:
    """The steady state that a running-in tends to; None where there is none.

    There is none where nothing presses in the end, where the contact grows, where load or speed
    change in time, or where the principle has no solution.
    """
    free, grows = system.holder.free, any(_beyond(system))
    if not (len(free) and free.all()) or (grows and settings.until is None):
        return None
    if _changes(system.case) or not system.laws:
        return None
    try:
        return steady_state(system)
    except ComputationError:
        if settings.until == "steady":
            raise
        return None


def _changes(case: Case) -> bool:
    """Whether load or speed change in time."""
    motion = case.motion
    return case.load.history is not None or (motion is not None and motion.history is not None)


def _wear_velocity(system: System, velocity: np.ndarray | None) -> dict[str, float | None]:
    """Rigid-body wear velocities by the motions of the holder [m/s, rad/s]."""
    found: dict[str, float | None] = {_VELOCITIES["z"]: None}
    if velocity is not None:
        names = system.case.holder.free
        found |= {_VELOCITIES[k]: float(v) for k, v in zip(names, velocity, strict=True)}
    return found


def _transient(system: System, observer: Observer, before: RunningIn | None = None) -> Outcome:
    """Running-in, with what the steady state that it tends to adds to the summary."""
    settings = system.case.analysis
    assert isinstance(settings, Transient)
    steady = None

    def principle(system: System) -> SteadyState | None:
        nonlocal steady
        steady = _principle(system, settings)
        return steady

    outcome = running_in(system, _problem(system, observer), principle, observer, before)
    velocity = _wear_velocity(system, None if steady is None else steady.wear.velocity)
    return replace(outcome, extra=outcome.extra | velocity)


def _stability(system: System, observer: Observer) -> Outcome:
    """Disturbances of the steady state, or of the cold unworn contact where there is none."""
    free = system.holder.free
    if system.laws and len(free) and free.all():
        return stability(system, _steady(system, observer), observer)
    cold = InterfaceProblem(system, CondensedMethod(system), None)
    return stability(system, _unworn(system, cold), observer)


_ANALYSES: dict[str, Callable[..., Outcome]] = {
    "initial": _initial,
    "steady": _steady,
    "transient": _transient,
    "fretting": fretting,
    "reciprocating": reciprocating,
    "stability": _stability,
}
