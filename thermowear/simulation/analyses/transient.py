"""Transient analysis: contact, wear and heat in time, to an end time or the steady state."""

from __future__ import annotations

from ...case.tables.analyses import Transient
from ...errors import ComputationError
from ...results import Result
from ..geometry_update.face_limits import beyond
from ..geometry_update.outer_loop import OuterLoop
from ..interface.factory import interface_problem
from ..interface.steady import SteadyState, steady_state
from ..model.system import System
from ..results.recording import FinalState
from ..results.summary import conclude
from ..runtime.guarded_loop import go_through
from ..runtime.observer import Observer
from ..time.step_sizes import AnySize, FewSizes
from ..time.time_loop import times_to_hit
from .static import wear_velocity
from .transient_record import RunningIn, RunningInRecord


def running_in(
    system: System, observer: Observer, before: RunningIn | None = None
) -> tuple[FinalState, Result]:
    """Follow contact in time, from the start or from a checkpoint.

    Results computed before an error or Ctrl-C are kept. The summary includes the wear velocities of
    the steady state that is approached.
    """
    settings = system.case.analysis
    assert isinstance(settings, Transient)
    problem = interface_problem(system, observer.note)
    sizes = FewSizes(times_to_hit(settings, problem)) if problem.stores_heat else AnySize()
    loop = OuterLoop(system, problem, _principle, sizes, observer)
    record = RunningInRecord(loop, observer)
    begun = None if before is None else record.go_on(before)
    passing = record.watched(loop.moments(begun))
    last, stopped = go_through(system, "time stepping", passing, record, observer, begun)
    with system.phases("bodies"):
        contact, motion, state, interface = record.bodies(last)
    velocity = None if loop.steady is None else loop.steady.wear.velocity
    return conclude(
        FinalState(loop.system, contact, motion, state),
        interface,
        record.extra() | wear_velocity(system, velocity),
        history=record.rows,
        outputs=record.outputs,
        heat=record.heat,
        stopped=stopped,
    )


def _principle(system: System) -> SteadyState | None:
    """Steady state that a transient analysis approaches; None if there is none.

    There is none unless all holder modes are free, for a growing contact, for inputs given over
    time, for wear laws that depend on the depth, or if the principle has no solution.
    """
    settings = system.case.analysis
    assert isinstance(settings, Transient)
    free, grows = system.holder.free, any(beyond(system))
    if not (len(free) and free.all()) or (grows and settings.until is None):
        return None
    if system.case.histories or not system.laws:
        return None
    if any("depth" in law.variables for law in system.laws.values()):
        return None
    try:
        return steady_state(system)
    except ComputationError:
        if settings.until == "steady":
            raise
        return None
