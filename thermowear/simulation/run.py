"""From a case to a result: the three analyses, told as a story."""

from __future__ import annotations

import numpy as np

from ..case.schema import Case, Transient
from ..errors import ComputationError
from .fields import sample
from .interface_problem import InterfaceProblem
from .interrupt import StopRequest
from .outcome import Outcome
from .phases import Phases
from .result import HistoryRow, Interface, Result
from .state import BodyState, body_state
from .steady import steady_wear
from .summary import summarise
from .system import System, build
from .transient import Moment, moments


class Observer:
    """Told what happens during a run; the base class ignores it. Called on every rank."""

    def phase(self, name: str) -> None:
        """A phase of the run begins."""

    def step(self, row: HistoryRow, distance: float) -> None:
        """A step of a transient analysis was accepted, at a distance from the steady pressure."""

    def output(self, time: float, interface: Interface) -> None:
        """An output time was reached."""


def run(
    case: Case, comm=None, observer: Observer | None = None, phases: Phases | None = None
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
    system = build(case, comm, phases)
    outcome = _ANALYSES[case.analysis.type](system, observer)
    with phases("fields"):
        fields = sample(system, outcome.state, outcome.motion)
    summary = summarise(system, outcome)
    return Result(
        outcome.interface, summary, outcome.history, outcome.outputs, fields, outcome.stopped
    )


def _initial(system: System, observer: Observer) -> Outcome:
    """Contact of the unworn faces."""
    problem = InterfaceProblem(system)
    with system.phases("contact"):
        solution = problem.unworn()
    pressure = problem.pressure(solution)
    still = np.zeros((2, len(pressure)))
    state, interface = _at(system, pressure, solution.motion, still)
    return Outcome(pressure, solution.motion, state, interface, {"steps": 0}, [], {})


def _steady(system: System, observer: Observer) -> Outcome:
    """The steady state; the faces are as if they had worn into each other."""
    with system.phases("steady principle"):
        steady = steady_wear(system)
    with system.phases("bodies"):
        state = body_state(system, steady.pressure)
    shape = state.opening - state.opening.min()
    pressing = steady.pressure > 0
    # the holder stands where the unworn face would lose just enough material to fit
    motion = np.array([state.opening.max()])
    interface = _interface(
        system,
        steady.pressure,
        state,
        gap=np.where(pressing, 0.0, np.nan),
        shape=shape,
        worn=np.zeros((2, len(shape))),
    )
    extra = {
        "steps": 0,
        "rigid_wear_velocity_m_per_s": float(steady.velocity[0]),
        "wear_dissipation_W": steady.dissipation,
    }
    return Outcome(steady.pressure, motion, state, interface, extra, [], {})


def _transient(system: System, observer: Observer) -> Outcome:
    """Running-in. What was computed before an error or Ctrl-C is kept."""
    settings = system.case.analysis
    assert isinstance(settings, Transient)
    steady = steady_wear(system)
    problem = InterfaceProblem(system)
    history: list[HistoryRow] = []
    outputs: dict[float, Interface] = {}
    last: Moment | None = None
    stopped: BaseException | None = None
    with system.phases("time stepping"), StopRequest() as stop:
        try:
            for moment in moments(problem, settings, steady.pressure):
                last = moment
                history.append(_row(system, problem, moment))
                observer.step(history[-1], moment.distance)
                if moment.is_output:
                    with system.phases("output"):
                        outputs[moment.time] = _moment(system, moment)[1]
                        observer.output(moment.time, outputs[moment.time])
                if stop.agreed(system.comm):
                    stopped = KeyboardInterrupt()
                    break
        except ComputationError as reason:
            stopped = reason
    if last is None:
        raise stopped or ComputationError("transient: no step was made")
    with system.phases("bodies"):
        state, interface = _moment(system, last)
    extra = {
        "steps": len(history) - 1,
        "time_s": last.time,
        "distance_from_steady": last.distance,
        "rigid_wear_velocity_m_per_s": float(steady.velocity[0]),
    }
    pressure, motion = last.state.pressure, last.state.solution.motion
    return Outcome(pressure, motion, state, interface, extra, history, outputs, stopped)


_ANALYSES = {"initial": _initial, "steady": _steady, "transient": _transient}


def _by_body(system: System, worn: np.ndarray) -> np.ndarray:
    """Rows for both bodies from rows for the wearing ones, shape (2, n)."""
    both = np.zeros((2, worn.shape[1]))
    both[list(system.laws)] = worn
    return both


def _row(system: System, problem: InterfaceProblem, moment: Moment) -> HistoryRow:
    pressure = moment.state.pressure
    volumes = _by_body(system, moment.state.worn) @ system.weights
    mean_speed = float(np.average(system.speed, weights=system.weights))
    return HistoryRow(
        time=moment.time,
        sliding_distance=mean_speed * moment.time,
        max_pressure=float(pressure.max()),
        contact_area=float(system.weights[pressure > 0].sum()),
        wear_volume_1=float(volumes[0]),
        wear_volume_2=float(volumes[1]),
        max_temperature=problem.hottest(pressure),
        approach=float(moment.state.solution.motion[0]),
        step=moment.step,
        error=moment.error,
    )


def _moment(system: System, moment: Moment) -> tuple[BodyState, Interface]:
    state = moment.state
    return _at(system, state.pressure, state.solution.motion, _by_body(system, state.worn))


def _at(system: System, pressure, motion, worn) -> tuple[BodyState, Interface]:
    """Bodies and interface at a contact state with known wear."""
    state = body_state(system, pressure)
    lost = system.pairing.gap + worn.sum(axis=0)
    gap = lost + state.opening - system.rigid @ motion
    return state, _interface(system, pressure, state, gap, lost.max() - lost, worn)


def _interface(system: System, pressure, state: BodyState, gap, shape, worn) -> Interface:
    points = system.pairing.points
    nothing = np.full(len(pressure), np.nan)
    rates = np.zeros((2, len(pressure)))
    for index, law in system.laws.items():
        rates[index] = law.rate(pressure, system.speed)
    temperatures: tuple[np.ndarray, np.ndarray] = (nothing, nothing)
    fluxes = temperatures
    if state.thermal is not None and system.thermal is not None:
        T1, T2 = state.thermal.rise
        temperatures = (T1 + system.thermal.ambient, T2 + system.thermal.ambient)
        fluxes = state.thermal.flux
    return Interface(
        x=points[:, 0],
        y=points[:, 1],
        z=np.zeros(len(pressure)),
        s=system.pairing.position,
        weight=system.weights,
        pressure=pressure,
        gap=gap,
        shape=shape,
        wear_1=worn[0],
        wear_2=worn[1],
        wear_rate_1=rates[0],
        wear_rate_2=rates[1],
        temperature_1=temperatures[0],
        temperature_2=temperatures[1],
        heat_flux_1=fluxes[0],
        heat_flux_2=fluxes[1],
    )
