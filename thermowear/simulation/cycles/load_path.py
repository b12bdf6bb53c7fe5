"""Load path of the cycles, and cycle jumps with Richardson error control.

A computed cycle that represents n cycles wears n times as much. Compared with n consecutive cycles
its error grows with ``n (n - 1)``, as a single cycle has none. Each jump is computed in two parts
and again as a whole: the difference D of the depths is ``2 n1 n2`` times the unknown error
constant, so that the two parts have the error

    D (n1 (n1 - 1) + n2 (n2 - 1)) / (2 n1 n2)

(Richardson extrapolation). It controls the jump size and is subtracted from the depths, which
leaves an error of second order. Each increment of the cycles is implicit, see
`contact.friction.slip_wear`, so that jumps of any size are stable.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import ClassVar, Protocol

import numpy as np

from ...contact.friction.gross_slip import FullSliding
from ...contact.friction.stick_slip_state import StickSlipState
from ...errors import ComputationError
from ...laws.histories import LoadHistories
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


_SAFETY, _SHORTER, _LONGER = 0.9, 0.2, 5.0


class Cycles(Protocol):
    """Protocol of a contact with computable load cycles."""

    areas: np.ndarray
    """Areas of the basis functions of the depths, shape (m,) [m²]."""

    def cycle(self, state: StickSlipState, number: int, repeats: int) -> Iterator[Increment]:
        """Increments of a cycle that represents all cycles since that of the state.

        Raises
        ------
        ComputationError
        """

    def equilibrium(self, end: Increment, state: StickSlipState) -> StickSlipState:
        """State at equal loads and energy with the wear of another state."""


def fixed_jumps(
    cycles: Cycles, numbers: Iterable[int], restart: RestartPoint
) -> Iterator[Increment]:
    """Compute the cycles of these numbers, each representing all since the previous one."""
    for number in numbers:
        if number > restart.cycle:
            span = number - restart.cycle
            for increment in cycles.cycle(restart.state, number, span):
                state = increment.state
                yield _marked(increment, Jump(span, math.nan, span))
            restart = RestartPoint(number, state, span)


def adaptive_jumps(
    cycles: Cycles, stops: Iterable[int], restart: RestartPoint, tolerance: float, longest: float
) -> Iterator[Increment]:
    """Compute all cycles in jumps with an error within the tolerance.

    Parameters
    ----------
    cycles : Cycles
    stops : iterable of int
        Cycles that no jump passes over, in order, including the last one.
    restart : RestartPoint
    tolerance : float
        Error relative to the largest worn depth.
    longest : float
        Largest number of cycles of a jump.

    Yields
    ------
    Increment
        Increments of the cycles of accepted jumps; rejected jumps yield nothing.

    Raises
    ------
    ComputationError
        If a single cycle fails.
    """
    for stop in stops:
        while restart.cycle < stop:
            span = _at_most(min(restart.following, longest), stop - restart.cycle)
            wanted = restart.following
            for increment in _jumped(cycles, restart, span, tolerance):
                if increment.jump is not None and increment.segment.cycle == stop:
                    following = max(increment.jump.following, wanted)
                    jump = replace(increment.jump, following=following)
                    increment = replace(increment, jump=jump)
                yield increment
            assert increment.restart is not None  # it ends the jump
            restart = increment.restart


def _at_most(wanted: float, left: int) -> int:
    """Whole number of cycles, chosen so that no short remainder is left."""
    return left if wanted >= left else max(1, int(min(wanted, math.ceil(left / 2))))


def _jumped(
    cycles: Cycles, restart: RestartPoint, wanted: int, tolerance: float
) -> Iterable[Increment]:
    """Increments of one jump, which is halved until its error is within the tolerance."""
    start, state, span, whole = restart.cycle, restart.state, wanted, None
    while span > 1:
        n1, n2 = span - span // 2, span // 2
        try:
            whole = whole or list(cycles.cycle(state, start + span, span))
            first = list(cycles.cycle(state, start + n1, n1))
            second = list(cycles.cycle(first[-1].state, start + span, n2))
        except FullSliding:
            raise
        except ComputationError:
            span, whole = n1, None
            continue
        two_parts = _TwoPartJump(n1, n2, state, whole[-1].state, second[-1])
        error = two_parts.error
        if error <= tolerance:
            jump = Jump(span, error, span * _growth(error, tolerance))
            return [*first, *second[:-1], replace(two_parts.corrected(cycles), jump=jump)]
        span, whole = n1, first  # the whole of the next attempt
    jump = Jump(1, 0.0, restart.following if wanted == 1 else 2.0)
    return (_marked(increment, jump) for increment in cycles.cycle(state, start + 1, 1))


@dataclass(frozen=True)
class _TwoPartJump:
    """Jump computed in two parts and as a whole, with the symbols of the module's docstring.

    Attributes
    ----------
    n1, n2 : int
    start, whole : StickSlipState
        States before the jump, and after it as a whole.
    end : Increment
        End of the second part.
    """

    n1: int
    n2: int
    start: StickSlipState
    whole: StickSlipState
    end: Increment

    @property
    def part(self) -> float:
        """Error of the two parts as a fraction of their difference from the whole."""
        single = self.n1 * (self.n1 - 1) + self.n2 * (self.n2 - 1)
        return single / (2 * self.n1 * self.n2)

    @property
    def excess(self) -> np.ndarray:
        """Excess depth after the two parts, shape (n_wearing, m) [m]."""
        return self.part * (self.whole.worn - self.end.state.worn)

    @property
    def error(self) -> float:
        """Largest excess depth relative to the largest depth; 0 without wear.

        Coefficients across the stick edge do not count: when it passes from one to the next, their
        depths change at once, however short the jump. `FrettingState.edge_error` estimates that.
        """
        largest = float(self.end.state.worn.max(initial=0.0))
        if largest == 0.0:
            return 0.0
        each = (self.start.crossed, self.whole.crossed, self.end.state.crossed)
        across = np.any(each, axis=0)
        excess = self.excess[:, ~across] if across.any() else self.excess
        return float(np.abs(excess).max(initial=0.0)) / largest

    def corrected(self, cycles: Cycles) -> Increment:
        """End of the second part with the estimated error subtracted."""
        if self.part == 0.0:
            return self.end
        start, whole, state, part = self.start, self.whole, self.end.state, self.part
        worn = start.worn + _nonnegative(state.worn - self.excess - start.worn, cycles.areas)
        dissipated = state.dissipated - part * (whole.dissipated - state.dissipated)
        spared = state.spared - part * (whole.spared - state.spared)
        outside = np.all([one.part < 1.0 for one in (start, whole, state)], axis=0)
        excess = state.excess - np.where(outside, part * (whole.excess - state.excess), 0.0)
        excess = np.maximum(excess, 0.0)
        settled = replace(state, worn=worn, spared=spared, excess=excess)
        found = cycles.equilibrium(self.end, settled)
        found = replace(found, dissipated=dissipated, status=state.status)
        return replace(self.end, state=found)


def _growth(error: float, tolerance: float) -> float:
    """Size factor for the next jump; the error is quadratic in the number of cycles."""
    if error == 0.0:
        return _LONGER
    return float(np.clip(_SAFETY * math.sqrt(tolerance / error), _SHORTER, _LONGER))


def _nonnegative(gains: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """Depth gains (n_wearing, m) with negative values clipped and the others scaled down.

    Volumes are preserved, so that they remain consistent with the dissipated energy.
    """
    kept = np.maximum(gains, 0.0)
    volumes = np.where(kept.any(axis=1), kept @ areas, 1.0)
    return kept * np.maximum(gains @ areas / volumes, 0.0)[:, None]


def _marked(increment: Increment, jump: Jump) -> Increment:
    """Increment with the jump attached if it ends a cycle."""
    ends = increment.ends_segment and increment.segment.ends_cycle
    return replace(increment, jump=jump) if ends else increment
