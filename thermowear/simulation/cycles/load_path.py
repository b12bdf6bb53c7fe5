"""The way through a history of loads and through the repetitions of its cycle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ...case.tables.analyses import Fretting
from ...case.tables.history import History
from ...serialise import serialisable

_SAME = 1e-9  # of the history: instants so near to each other are one


@serialisable
@dataclass(frozen=True)
class LoadSegment:
    """A straight line of the loads.

    Attributes
    ----------
    start, end : float
        When it begins and ends [s].
    instant : float
        Of the history: its loads are those at the end [s].
    cycle : int
        Number of the cycle, 0 before the first one.
    repeats : int
        How many cycles it stands for.
    is_output : bool
        Whether the end is one of the output times.
    ends_cycle : bool
    """

    start: float
    end: float
    instant: float
    cycle: int
    repeats: int
    is_output: bool
    ends_cycle: bool


def first_pass(history: History, output_times: tuple[float, ...]) -> Iterator[LoadSegment]:
    """The legs before the first cycle.

    The first one has no duration: it loads the bodies at the first instant.
    """
    begin = history.time[-1] if history.cycle is None else history.cycle[0]
    start = history.time[0]
    for instant, time, is_output in _corners(history, -math.inf, begin, 0.0, output_times):
        yield LoadSegment(start, time, instant, 0, 1, is_output, False)
        start = time


def cycle_legs(
    history: History, output_times: tuple[float, ...], number: int, repeats: int = 1
) -> Iterator[LoadSegment]:
    """The legs of a cycle of a history that has one; time goes on through all cycles.

    Parameters
    ----------
    history : History
    output_times : tuple of float
        Those that fall into it are hit [s].
    number : int
        Of the cycle, from 1 on.
    repeats : int
        How many cycles it stands for: the last of them.
    """
    assert history.cycle is not None
    begin, last = history.cycle
    shift = (number - 1) * (last - begin)
    start = begin + shift
    for instant, time, is_output in _corners(history, begin, last, shift, output_times):
        yield LoadSegment(start, time, instant, number, repeats, is_output, instant == last)
        start = time


def by_fixed_jumps(history: History, settings: Fretting, cycles: int, jump: int) -> list[int]:
    """Numbers of the cycles that are computed, each for all since the one before.

    Those are the first one, which begins unlike the others, and all with output times.
    """
    by_jump = range(jump, cycles, jump)
    of_outputs = {math.ceil(passed) for passed in _passed(history, settings)}
    return sorted({1, *by_jump, *of_outputs, cycles})


def to_stop_at(history: History, settings: Fretting, cycles: int) -> list[int]:
    """Numbers of the cycles that no jump may pass.

    A cycle with an output time before its end is computed for itself.
    """
    found = {1, cycles}
    for passed in _passed(history, settings):
        found |= {math.floor(passed), math.ceil(passed)}
    return sorted(found - {0})


def _passed(history: History, settings: Fretting) -> Iterator[float]:
    """How many cycles are over at the output times, those after the first pass."""
    if history.cycle is None:
        return
    begin, last = history.cycle
    for time in settings.output_times:
        passed = (time - begin) / (last - begin)
        if passed > _SAME:
            near = round(passed)
            yield near if abs(passed - near) <= _SAME else passed


def _corners(
    history: History, begin: float, end: float, shift: float, outputs: tuple[float, ...]
) -> list[tuple[float, float, bool]]:
    """Instants of the history in ``begin < instant <= end`` at which a leg ends.

    Returns
    -------
    list of tuple
        Instant, the time then [s], and whether that is an output time.
    """
    near = _SAME * (history.time[-1] - history.time[0])
    times = {t: t + shift for t in (*history.time, end) if begin < t <= end}
    marked = set()
    for time in outputs:
        instant = next((t for t in times if abs(t + shift - time) <= near), time - shift)
        if begin + near < instant <= end:
            times[instant] = time
            marked.add(instant)
    return [(t, times[t], t in marked) for t in sorted(times)]
