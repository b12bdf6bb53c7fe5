"""Running-in: contact, heat and wear in time, to an end time or to the steady state."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..case.analyses import Timed
from ..errors import ComputationError
from .step_sizes import AnySize, StepSizes, ends
from .wear_step import WearProblem, WornContact, advance_with_error, next_step

_SMALLEST = 1e-12  # of the time that has passed


@dataclass(frozen=True)
class Moment:
    """A state of the running-in.

    Attributes
    ----------
    time, step : float
        End and size of the step that led here [s].
    state : WornContact
    error : float
        Error estimate of the step.
    is_output : bool
        Whether this is one of the output times.
    distance : float
        From the steady state, see `WearProblem`; NaN without one.
    """

    time: float
    step: float
    state: WornContact
    error: float
    is_output: bool
    distance: float


def moments(
    problem: WearProblem, settings: Timed, steady, sizes: StepSizes | None = None
) -> Iterator[Moment]:
    """The moments of a running-in, from the unworn contact on.

    Parameters
    ----------
    problem : WearProblem
    settings : Transient
    steady : object
        The steady state that the problem tends to, as it takes it; None without one.
    sizes : StepSizes, optional
        Any by default.

    Raises
    ------
    ComputationError
        If the step has become too small or the steps too many. What was yielded stays valid.
    """
    sizes = sizes or AnySize()
    state = problem.start()
    steady = None if steady is None else problem.steady(steady)
    distance = problem.distance(state, steady)
    time, begin, wanted = 0.0, 0.0, problem.first_step(state)
    targets = times_to_hit(settings, problem)
    yield Moment(0.0, 0.0, state, 0.0, False, distance)
    for _ in range(settings.max_steps):
        if not targets or _is_steady(settings, distance):
            return
        way = partial(sizes.at_most, time=time, begin=begin, end=targets[0])
        state, step, error, following = _accept(problem, state, way, wanted, time, settings)
        hits = ends(step, targets[0] - time)
        time = targets[0] if hits else time + step
        distance = problem.distance(state, steady)
        wanted = max(following, wanted) if hits else following
        begin, reached = (time, targets.pop(0)) if hits else (begin, None)
        yield Moment(time, step, state, error, reached in settings.output_times, distance)
    if targets and not _is_steady(settings, distance):
        raise ComputationError(
            f"{settings.type}: {settings.max_steps} steps were not enough (analysis.max_steps), "
            f"the run stands at {time:g} s"
        )


def _accept(problem, state, way, wanted, time, settings):
    """Repeat a step with smaller sizes until its error is within the tolerance."""
    trouble, step = "", way(wanted)
    while step > _SMALLEST * max(time, _SMALLEST):
        try:
            following, error = advance_with_error(problem, state, time, step)
        except ComputationError as failure:
            step, trouble = way(step / 4), f" ({failure})"
            continue
        proposed = next_step(step, error, settings.tolerance)
        if error <= settings.tolerance:
            return following, step, error, proposed
        step = way(min(proposed, 0.9 * step))
    raise ComputationError(f"{settings.type}: no step is small enough at {time:g} s{trouble}")


def times_to_hit(settings: Timed, problem: WearProblem) -> list[float]:
    """Times that must be hit exactly, in order; the last one ends the run."""
    end = np.inf if settings.end_time is None else settings.end_time
    corners = () if settings.end_time is None else problem.corners(end)
    return sorted({*settings.output_times, *corners, end})


def _is_steady(settings: Timed, distance: float) -> bool:
    return settings.until == "steady" and distance <= settings.steady_tolerance
