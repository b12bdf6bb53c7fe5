"""Transient analysis: contact, wear and heat in time, to an end time or the steady state."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from ...errors import ComputationError
from ...model.analyses import TransientAnalysis
from ...results import Result
from ..geometry_update.face_limits import beyond
from ..geometry_update.outer_loop import OuterLoop
from ..interface.factory import interface_problem
from ..interface.steady import SteadyState, steady_state
from ..results.recording import Snapshot
from ..runtime.checkpoint_data import Progress
from ..runtime.observer import Observer
from ..system.system import System
from ..time.step_sizes import AnySize, FewSizes
from ..time.time_loop import Moment, times_to_hit
from .transient_history import TransientHistory


def running_in(
    system: System,
    settings: TransientAnalysis,
    observer: Observer,
    before: Progress | None = None,
) -> tuple[Snapshot, Result]:
    """Follow contact in time, from the start or from a checkpoint.

    Results computed before an error or Ctrl-C are kept. The summary includes the wear velocities of
    the steady state that is approached.
    """
    history, passing = transient_history(system, settings, observer, before)
    return history.conclude(history.follow("time stepping", passing))


def transient_history(
    system: System,
    settings: TransientAnalysis,
    observer: Observer,
    before: Progress | None = None,
) -> tuple[TransientHistory, Iterator[Moment]]:
    """Empty history of a transient analysis, and the moments to keep in it, made one by one."""
    problem = interface_problem(system, observer.note)
    sizes = FewSizes(times_to_hit(settings, problem)) if problem.stores_heat else AnySize()
    loop = OuterLoop(system, settings, problem, partial(_principle, settings), sizes, observer)
    history = TransientHistory(loop, settings, observer)
    return history, history.watched(loop.moments(history.resume(before)))


def _principle(settings: TransientAnalysis, system: System) -> SteadyState | None:
    """Steady state that a transient analysis approaches; None if there is none.

    There is none unless all holder modes are free, for a growing contact, for inputs given over
    time, for wear laws that depend on the depth, or if the principle has no solution.
    """
    free, grows = system.holder.free, any(beyond(system))
    if not (len(free) and free.all()) or (grows and settings.until is None):
        return None
    if system.model.histories or not system.laws:
        return None
    if any("depth" in law.variables for law in system.laws.values()):
        return None
    try:
        return steady_state(system)
    except ComputationError:
        if settings.until == "steady":
            raise
        return None
