"""Going through the states of an analysis until it ends, fails, or is asked to stop."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from ..errors import ComputationError
from .interrupt import StopRequest
from .system import System

State = TypeVar("State")


def go_through(
    system: System, phase: str, states: Iterable[State], keep: Callable[[State], None]
) -> tuple[State, BaseException | None]:
    """Keep one state after the other; those before an error or Ctrl-C are not lost.

    Parameters
    ----------
    system : System
    phase : str
        Name of the phase that it counts for.
    states : iterable
        At least one.
    keep : callable
        Told each state.

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
    """
    passed: list[State] = []
    with system.phases(phase), StopRequest() as stop:
        try:
            for state in states:
                keep(state)
                passed[:] = [state]
                if stop.agreed(system.comm):
                    return state, KeyboardInterrupt()
        except ComputationError as reason:
            if not passed:
                raise
            return passed[0], reason
    return passed[0], None
