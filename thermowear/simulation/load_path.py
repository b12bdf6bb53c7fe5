"""The way through a history of loads and through the repetitions of its cycle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ..case.analyses import Fretting
from ..case.history import History

_SAME = 1e-9  # of the history: instants so near to each other are one


@dataclass(frozen=True)
class Leg:
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


def legs(history: History, settings: Fretting) -> Iterator[Leg]:
    """All legs, one after the other.

    The first one has no duration: it loads the bodies at the first instant. Time goes on through
    all cycles. Of those that are jumped the last is computed and stands for them all. The first
    one, which begins unlike the others, and cycles with output times are always computed.
    """
    first, last = history.time[0], history.time[-1]
    begin = last if history.cycle is None else history.cycle[0]
    outputs = settings.output_times
    start = first
    for instant, time, is_output in _corners(history, -math.inf, begin, 0.0, outputs):
        yield Leg(start, time, instant, 0, 1, is_output, False)
        start = time
    before = 0
    for cycle in () if history.cycle is None else _computed(settings, begin, last - begin):
        shift = (cycle - 1) * (last - begin)
        start = begin + shift
        for instant, time, is_output in _corners(history, begin, last, shift, outputs):
            yield Leg(start, time, instant, cycle, cycle - before, is_output, instant == last)
            start = time
        before = cycle


def _computed(settings: Fretting, begin: float, period: float) -> list[int]:
    """Numbers of the cycles that are computed."""
    by_jump = range(settings.jump, settings.cycles, settings.jump)
    passed = [(time - begin) / period for time in settings.output_times]
    of_outputs = {math.ceil(cycles - _SAME) for cycles in passed if cycles > _SAME}
    return sorted({1, *by_jump, *of_outputs, settings.cycles})


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
