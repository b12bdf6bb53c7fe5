"""Times that steps end at: those to be hit, and given time steps."""

from __future__ import annotations

import numpy as np

from ...errors import ComputationError
from ...model.analyses import TimedAnalysis
from ..interface.sdirk import WearProblem

ROUNDED = 1e-10
"""Relative difference of times that are the same but for rounding."""


def is_same(time: float, other: float) -> bool:
    """Test whether two times [s] differ by rounding alone."""
    first, second = min(time, other), max(time, other)
    return second - first <= ROUNDED * abs(first)


def require_valid(settings: TimedAnalysis, targets: list[float]) -> None:
    """Require given steps to increase, to hit the targets [s] in between, and not to pass all."""
    steps = settings.steps
    if not steps:
        return
    if not np.all(np.diff([0.0, *steps, targets[-1] * (1 + ROUNDED)]) > 0.0):
        raise ComputationError(
            f"{settings.type}: the given ends of time steps must increase from 0 to the end time "
            "at most"
        )
    inside = {time for time in targets if time <= steps[-1]} - set(steps)
    missed = sorted(t for t in inside if not any(is_same(t, step) for step in steps))
    if missed:
        raise ComputationError(
            f"{settings.type}: none of the given time steps ends at {missed[0]:g} s, an output "
            "time or a kink of a history"
        )


def times_to_hit(settings: TimedAnalysis, problem: WearProblem) -> list[float]:
    """Times that must be hit exactly, in increasing order; the last one ends the run [s].

    Of times that are the same but for rounding one is kept, output times rather than others.
    """
    end, result = settings.end_time, list[float]()
    named = {*settings.output_times, *(t for t in settings.hits if t <= end), end}
    corners = () if end == np.inf else problem.corners(end)
    for time in sorted({*named, *corners}):
        if not result or not is_same(result[-1], time):
            result.append(time)
        elif time in named:
            result[-1] = time
    return result
