"""Time loop of contact, heat and wear, to an end time or to the steady state, with step control.

Given steps, such as those of an earlier run, are taken again without error control.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...errors import ComputationError
from ...model.analyses import TimedAnalysis
from ...serialise import serialisable
from ..interface.sdirk import (
    InterfaceState,
    TrialStep,
    WearProblem,
    advance_with_error,
    advance_without_error,
)
from .step_sizes import AnySize, StepSizes, ends, next_step

_FAR_SMALLER = 1e-3
"""Size ratio of trial steps for detecting jumps: time errors fall at least by its square root."""
_SMALLEST = 1e-12  # relative to the elapsed time; at the start to 1e-12 s

_ROUNDING, _STILL = 1e-9, 20
"""Error and number of successive steps, ever larger ones, in which nothing changes any more."""


@serialisable
@dataclass(frozen=True)
class Moment:
    """Accepted state of the running-in with the data to continue the time loop from it.

    Attributes
    ----------
    time, step : float
        End and size of the last step [s].
    state : InterfaceState
    error : float
        Error estimate of the step; NaN for a given step.
    is_output : bool
        True at an output time.
    distance : float
        Distance from the steady state, see `WearProblem`; NaN without one.
    number : int
        Number of the step.
    begin : float
        Last time that was hit exactly [s].
    wanted : float
        Size of the next step proposed by error control [s].
    """

    time: float
    step: float
    state: InterfaceState
    error: float
    is_output: bool
    distance: float
    number: int
    begin: float
    wanted: float


def moments(
    problem: WearProblem,
    settings: TimedAnalysis,
    steady,
    sizes: StepSizes | None = None,
    last: Moment | None = None,
) -> Iterator[Moment]:
    """Accepted states of a running-in, beginning with the unworn contact.

    Parameters
    ----------
    problem : WearProblem
    settings : TimedAnalysis
    steady : object
        Steady state in the form that ``problem.distance`` takes; None without one.
    sizes : StepSizes, optional
        `AnySize` by default.
    last : Moment, optional
        State to continue from; it is not yielded again.

    Raises
    ------
    ComputationError
        If the step becomes too small or the number of steps too large. Yielded states stay valid.
    """
    sizes = sizes or AnySize()
    if last is None:
        state = problem.start()
        distance, wanted = problem.distance(state, steady), problem.first_step(state)
        last = Moment(0.0, 0.0, state, 0.0, False, distance, 0, 0.0, wanted)
        yield last
    times = times_to_hit(settings, problem)
    targets = [time for time in times if time > last.time]
    _require_valid(settings, times)
    advanced, still = _repeated if settings.steps else _next, 0
    while not is_over(settings, last):
        if last.number == settings.max_steps and not settings.steps:
            raise ComputationError(
                f"{settings.type}: {settings.max_steps} steps were not enough "
                f"(analysis.max_steps), the run stands at {last.time:g} s"
            )
        last = advanced(problem, settings, steady, sizes, targets[0], last)
        if last.time == targets[0]:
            targets.pop(0)
        yield last
        still = still + 1 if last.error <= _ROUNDING else 0
        if still == _STILL and targets == [math.inf]:
            raise ComputationError(
                f"{settings.type}: nothing changes any more at {last.time:.4g} s, at a distance of "
                f"{last.distance:.2g} from the steady state (analysis.steady_tolerance = "
                f"{settings.steady_tolerance:g}); use a finer mesh, or a larger tolerance"
            )


def is_over(settings: TimedAnalysis, last: Moment) -> bool:
    """Test whether the running-in ends with this state."""
    if settings.steps:
        return last.number == len(settings.steps)
    steady = settings.until == "steady" and last.distance <= settings.steady_tolerance
    return steady or last.time >= max((settings.end_time, *settings.output_times))


def _require_valid(settings: TimedAnalysis, targets: list[float]) -> None:
    """Require given steps to increase, to hit the targets [s] in between, and not to pass all."""
    steps = settings.steps
    if not steps:
        return
    if not np.all(np.diff([0.0, *steps, targets[-1] * (1 + _SMALLEST)]) > 0.0):
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


def _repeated(
    problem: WearProblem,
    settings: TimedAnalysis,
    steady,
    sizes: StepSizes,
    target: float,
    last: Moment,
) -> Moment:
    """Given step, without error control, before or up to a target time [s]."""
    time = settings.steps[last.number]
    step = sizes.nominal(time - last.time, last.begin, target)
    try:
        state = advance_without_error(problem, last.state, last.time, step)
    except ComputationError as failure:
        raise ComputationError(
            f"{settings.type}: the given step from {last.time:g} to {time:g} s failed ({failure})"
        ) from None
    return Moment(
        time=time,
        step=step,
        state=state,
        error=math.nan,
        is_output=time in settings.output_times,
        distance=problem.distance(state, steady),
        number=last.number + 1,
        begin=target if time == target else last.begin,
        wanted=step,
    )


def _next(
    problem: WearProblem,
    settings: TimedAnalysis,
    steady,
    sizes: StepSizes,
    target: float,
    last: Moment,
) -> Moment:
    """Step towards a target time that must be hit exactly [s]."""
    size = partial(sizes.at_most, time=last.time, begin=last.begin, end=target)
    smallest = _SMALLEST * max(last.time, min(_SMALLEST, target))  # a first target may be tiny
    trial, step, following = _accept(problem, last, size, sizes.rounding, smallest, settings)
    hits = ends(step, target - last.time)
    time = target if hits else last.time + step
    return Moment(
        time=time,
        step=step,
        state=trial.state,
        error=trial.error,
        is_output=hits and target in settings.output_times,
        distance=problem.distance(trial.state, steady),
        number=last.number + 1,
        begin=target if hits else last.begin,
        wanted=max(following, last.wanted) if hits else following,
    )


def _accept(
    problem, last: Moment, size, rounding: float, smallest: float, settings
) -> tuple[TrialStep, float, float]:
    """Repeat a step with smaller sizes until its error is within the tolerance.

    Step sizes that must end behind an event are increased by ``rounding`` to do so once rounded.

    With pointwise contact, an error that does not decrease in a far smaller step is a jump: a point
    begins to press suddenly. That step, which ends right behind the event, is accepted.

    Returns the step with its size, and the size of the next one as proposed by error control [s].
    """
    trouble, step = "", size(last.wanted)
    # errors decrease steadily while the transient after a point begins to press decays
    former = None if last.state.pointwise is None else (last.step, last.error)
    tried: list[tuple[float, float]] = []
    while step > smallest:
        try:
            trial = advance_with_error(problem, last.state, last.time, step)
        except ComputationError as failure:
            step, trouble = size(step / 4), f" ({failure})"
            continue
        error = trial.error
        proposed = next_step(step, error, settings.tolerance, former)
        if error <= settings.tolerance:
            return trial, step, min(proposed, rounding * trial.following)
        jumps = any(step <= _FAR_SMALLER * tried_size and error > e / 2 for tried_size, e in tried)
        if jumps and trial.state.pointwise is not None:
            return trial, step, step / _FAR_SMALLER
        tried.append((step, error))
        located = rounding * trial.reached if trial.reached < 0.9 * step else 0.0
        step = size(min(max(proposed, located), 0.9 * step))
    raise ComputationError(f"{settings.type}: no step is small enough at {last.time:g} s{trouble}")


def times_to_hit(settings: TimedAnalysis, problem: WearProblem) -> list[float]:
    """Times that must be hit exactly, in increasing order; the last one ends the run [s]."""
    end = settings.end_time
    corners = () if end == np.inf else problem.corners(end)
    return sorted({*settings.output_times, *(t for t in settings.hits if t <= end), *corners, end})
