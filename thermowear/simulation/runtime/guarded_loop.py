"""Going through the states of an analysis until it ends, fails, or is asked to stop."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

from ...errors import ComputationError, UnwritableError
from ..model.system import System
from .checkpoint_policy import KeptStates, Saving
from .observer import Observer
from .stop_signal import StopRequest, interrupted

State = TypeVar("State")


def go_through(
    system: System,
    phase: str,
    states: Iterable[State],
    record: KeptStates,
    observer: Observer,
    last: State | None = None,
) -> tuple[State, BaseException | None]:
    """Keep and save one state after the other; those before an error or Ctrl-C are not lost.

    A request to stop ends it after the present state. It counts also where that is the last one:
    what follows writes the results of a whole analysis, and says that it was interrupted.

    Parameters
    ----------
    system : System
    phase : str
        Name of the phase that it counts for.
    states : iterable
        At least one, unless it goes on from a last one.
    record : KeptStates
    observer : Observer
    last : object, optional
        State that it goes on from.

    Returns
    -------
    last : object
        The last state.
    stopped : BaseException or None
        What stopped it before the end.

    Raises
    ------
    ComputationError
        If there was no first state.
    UnwritableError
        If results cannot be written any more.
    """
    saving = Saving(system, record, observer)
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
