"""Loop over the states of an analysis that keeps accepted states on error or interrupt."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

from ...errors import ComputationError, UnwritableError
from ...model.analyses import SteppedAnalysis
from ..model.system import System
from .checkpoint_policy import KeptStates, Saving
from .observer import Observer
from .stop_signal import StopRequest, interrupted

State = TypeVar("State")


def go_through(
    system: System,
    settings: SteppedAnalysis,
    phase: str,
    states: Iterable[State],
    record: KeptStates,
    observer: Observer,
    last: State | None = None,
) -> tuple[State, BaseException | None]:
    """Record and save successive states; the ones before an error or Ctrl-C are kept.

    A stop request ends the loop after the present state. It also counts after the last one: the
    results of the whole analysis are then written and marked as interrupted.

    Parameters
    ----------
    system : System
    settings : SteppedAnalysis
    phase : str
        Name of the phase for timing.
    states : iterable
        At least one state, unless `last` is given.
    record : KeptStates
    observer : Observer
    last : object, optional
        State to restart from.

    Returns
    -------
    last : object
        The last state.
    stopped : BaseException or None
        Reason for stopping before the end.

    Raises
    ------
    ComputationError
        If the first state fails.
    UnwritableError
        If results cannot be written.
    """
    saving = Saving(system, settings, record, observer)
    stopped: BaseException | None = None
    with system.phases(phase), StopRequest() as stop:
        try:
            for state in states:
                record.keep(state)
                last = state
                if stop.agreed(system.comm):
                    break
                saving.passed(state)
        except UnwritableError:
            raise
        except ComputationError as reason:
            if last is None:
                raise
            stopped = reason
        assert last is not None
        saving.save()
    if stop.agreed(system.comm):
        stopped = interrupted(stopped)
    return last, stopped
