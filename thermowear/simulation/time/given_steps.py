"""Times that steps end at: those to be hit, and given time steps."""

from __future__ import annotations

import numpy as np

from ...errors import ComputationError
from ...model.analyses import TimedAnalysis
from ..interface.sdirk import WearProblem

_ROUNDED = 1e-12
"""Rounding of the end time."""


def require_valid(settings: TimedAnalysis, targets: list[float]) -> None:
    """Require given steps to increase, to hit the targets [s] in between, and not to pass all."""
    steps = settings.steps
    if not steps:
        return
    if not np.all(np.diff([0.0, *steps, targets[-1] * (1 + _ROUNDED)]) > 0.0):
        raise ComputationError(
            f"{settings.type}: the given ends of time steps must increase from 0 to the end time "
            "at most"
        )
    missed = sorted({time for time in targets if time <= steps[-1]} - set(steps))
    if missed:
        raise ComputationError(
            f"{settings.type}: none of the given time steps ends at {missed[0]:g} s, an output "
            "time or a kink of a history"
        )


def times_to_hit(settings: TimedAnalysis, problem: WearProblem) -> list[float]:
    """Times that must be hit exactly, in increasing order; the last one ends the run [s]."""
    end = settings.end_time
    corners = () if end == np.inf else problem.corners(end)
    return sorted({*settings.output_times, *(t for t in settings.hits if t <= end), *corners, end})
