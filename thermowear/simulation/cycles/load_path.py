"""Load path: segments of a load history and of its cycles, their increments, cycle jumps."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from ...contact.friction.stick_slip_state import StickSlipState
from ...laws.time_course import LoadHistory
from ...model.analyses import FrettingAnalysis
from ...serialise import serialisable

_SAME = 1e-9  # relative to the duration of the history: closer times are equal


@serialisable
@dataclass(frozen=True)
class LoadSegment:
    """Segment of the load history with linearly varying loads.

    Attributes
    ----------
    start, end : float
        Start and end time [s].
    instant : float
        Time in the history with the loads of the end [s].
    cycle : int
        Number of the cycle, 0 before the first one.
    repeats : int
        Number of cycles that it represents.
    is_output : bool
        True if the end is an output time.
    ends_cycle : bool
    """

    start: float
    end: float
    instant: float
    cycle: int
    repeats: int
    is_output: bool
    ends_cycle: bool


@serialisable
@dataclass(frozen=True)
class Jump:
    """Accepted cycle jump.

    Attributes
    ----------
    cycles : int
        Number of cycles.
    error : float
        Estimated error relative to the largest worn depth, before its correction; 0 where each
        cycle was computed, NaN where it was not estimated.
    following : float
        Proposed size of the next jump in cycles.
    """

    cycles: int
    error: float
    following: float


@serialisable
@dataclass(frozen=True)
class Increment:
    """State at the end of a load increment.

    Attributes
    ----------
    time : float
        [s]
    segment : LoadSegment
    ends_segment : bool
    state : StickSlipState
    jump : Jump or None
        Jump that ends here.
    """

    time: float
    segment: LoadSegment
    ends_segment: bool
    state: StickSlipState
    jump: Jump | None = None
    distance: ClassVar[float] = math.nan  # from a steady state

    @property
    def is_output(self) -> bool:
        """True if the increment ends at an output time."""
        return self.ends_segment and self.segment.is_output

    @property
    def restart(self) -> RestartPoint | None:
        """Restart point at the end of a jump, or of a segment before cycle 1; None elsewhere."""
        if self.jump is not None:
            return RestartPoint(self.segment.cycle, self.state, self.jump.following)
        before = self.ends_segment and self.segment.cycle == 0
        return RestartPoint(0, self.state) if before else None


@dataclass(frozen=True)
class RestartPoint:
    """Data to restart the load path from.

    Attributes
    ----------
    cycle : int
        Number of the last computed cycle; 0 before the first.
    state : StickSlipState
    following : float
        Proposed size of the next jump in cycles.
    """

    cycle: int
    state: StickSlipState
    following: float = 2.0


def first_pass(history: LoadHistory, output_times: tuple[float, ...]) -> Iterator[LoadSegment]:
    """Load segments before the first cycle.

    The first one has no duration: it applies the loads of the first time of the history.
    """
    begin = history.time[-1] if history.cycle is None else history.cycle[0]
    start = history.time[0]
    for instant, time, is_output in _corners(history, -math.inf, begin, 0.0, output_times):
        yield LoadSegment(start, time, instant, 0, 1, is_output, False)
        start = time


def cycle_segments(
    history: LoadHistory, output_times: tuple[float, ...], number: int, repeats: int = 1
) -> Iterator[LoadSegment]:
    """Load segments of a cycle of a periodic history; time continues through all cycles.

    Parameters
    ----------
    history : LoadHistory
    output_times : tuple of float
        Output times, each the end of a segment if it lies in the cycle [s].
    number : int
        Number of the cycle, from 1.
    repeats : int
        Number of cycles that it represents, itself the last.
    """
    assert history.cycle is not None
    begin, last = history.cycle
    shift = (number - 1) * (last - begin)
    start = begin + shift
    for instant, time, is_output in _corners(history, begin, last, shift, output_times):
        yield LoadSegment(start, time, instant, number, repeats, is_output, instant == last)
        start = time


def jumped_cycles(
    history: LoadHistory, settings: FrettingAnalysis, cycles: int, jump: int
) -> list[int]:
    """Numbers of the computed cycles, each representing all since the previous one.

    Includes the first cycle, which starts from a different state, and all with output times.
    """
    by_jump = range(jump, cycles, jump)
    of_outputs = {math.ceil(passed) for passed in _passed(history, settings)}
    return sorted({1, *by_jump, *of_outputs, cycles})


def cycles_to_stop_at(history: LoadHistory, settings: FrettingAnalysis, cycles: int) -> list[int]:
    """Numbers of the cycles that no jump may pass over.

    A cycle with an output time before its end is computed individually.
    """
    found = {1, cycles}
    for passed in _passed(history, settings):
        found |= {math.floor(passed), math.ceil(passed)}
    return sorted(found - {0})


def _passed(history: LoadHistory, settings: FrettingAnalysis) -> Iterator[float]:
    """Numbers of cycles elapsed at the output times after the first pass."""
    if history.cycle is None:
        return
    begin, last = history.cycle
    for time in settings.output_times:
        passed = (time - begin) / (last - begin)
        if passed > _SAME:
            near = round(passed)
            yield near if abs(passed - near) <= _SAME else passed


def _corners(
    history: LoadHistory, begin: float, end: float, shift: float, outputs: tuple[float, ...]
) -> list[tuple[float, float, bool]]:
    """Times of the history in ``begin < instant <= end`` at which a load segment ends.

    Returns
    -------
    list of tuple
        Time in the history [s], time in the analysis [s], True for an output time.
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
