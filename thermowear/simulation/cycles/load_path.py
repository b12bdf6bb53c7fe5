"""Load path: segments of a load history and of its cycles, their increments, cycle jumps."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from ...contact.friction.stick_slip_state import StickSlipState
from ...laws.time_course import LoadHistories
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


@dataclass(frozen=True)
class LoadPath:
    """Load segments of a history and of its cycles; time continues through all cycles.

    Attributes
    ----------
    history : LoadHistories
    output_times : tuple of float
        Output times, each the end of a segment [s].
    """

    history: LoadHistories
    output_times: tuple[float, ...]

    def first_pass(self) -> Iterator[LoadSegment]:
        """Load segments before the first cycle.

        The first one has no duration: it applies the loads of the first time of the history.
        """
        cycle = self.history.cycle
        end = self.history.time[-1] if cycle is None else cycle[0]
        return self._segments(-math.inf, end, 0.0, 0, 1)

    def cycle(self, number: int, repeats: int = 1) -> Iterator[LoadSegment]:
        """Load segments of a cycle of a periodic history.

        Parameters
        ----------
        number : int
            Number of the cycle, from 1.
        repeats : int
            Number of cycles that it represents, itself the last.
        """
        assert self.history.cycle is not None
        begin, end = self.history.cycle
        return self._segments(begin, end, (number - 1) * (end - begin), number, repeats)

    def jumped_cycles(self, cycles: int, jump: int) -> list[int]:
        """Numbers of the computed cycles, each representing all since the previous one.

        Includes the first cycle, which starts from a different state, and all with output times.
        """
        of_outputs = {math.ceil(passed) for passed in self._passed()}
        return sorted({1, *range(jump, cycles, jump), *of_outputs, cycles})

    def cycles_to_stop_at(self, cycles: int) -> list[int]:
        """Numbers of the cycles that no jump may pass over.

        A cycle with an output time before its end is computed individually.
        """
        found = {1, cycles}
        for passed in self._passed():
            found |= {math.floor(passed), math.ceil(passed)}
        return sorted(found - {0})

    def _passed(self) -> Iterator[float]:
        """Numbers of cycles elapsed at the output times after the first pass."""
        if self.history.cycle is None:
            return
        begin, end = self.history.cycle
        for time in self.output_times:
            passed = (time - begin) / (end - begin)
            if passed > _SAME:
                near = round(passed)
                yield near if abs(passed - near) <= _SAME else passed

    def _segments(
        self, begin: float, end: float, shift: float, number: int, repeats: int
    ) -> Iterator[LoadSegment]:
        """Load segments of the times of the history in ``begin < instant <= end``.

        They are shifted in the analysis [s].
        """
        first, *_, last = self.history.time
        near = _SAME * (last - first)
        times = {t: t + shift for t in (*self.history.time, end) if begin < t <= end}
        marked = set()
        for time in self.output_times:
            instant = next((t for t in times if abs(t + shift - time) <= near), time - shift)
            if begin + near < instant <= end:
                times[instant] = time
                marked.add(instant)
        start = max(begin, first) + shift
        for instant, time in sorted(times.items()):
            ends_cycle = number > 0 and instant == end
            yield LoadSegment(start, time, instant, number, repeats, instant in marked, ends_cycle)
            start = time
