"""Time loop of contact, heat and wear, to an end time or to the steady state."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...errors import ComputationError
from ...model.analyses import TimedAnalysis
from ...serialise import serialisable
from ..interface.sdirk import InterfaceState, TrialStep, WearProblem, advance_with_error, next_step
from .step_sizes import AnySize, StepSizes, ends

_FAR_SMALLER = 1e-3
"""Size ratio of trial steps for detecting jumps: time errors fall at least by its square root."""
_SMALLEST = 1e-12  # relative to the elapsed time; at the start to 1e-12 s


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
        Error estimate of the step.
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
        Steady state in the form that ``problem.steady`` takes; None without one.
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
    steady = None if steady is None else problem.steady(steady)
    if last is None:
        last = _first(problem, steady)
        yield last
    targets = [time for time in times_to_hit(settings, problem) if time > last.time]
    while not is_over(settings, problem, last):
        if last.number == settings.max_steps:
            raise ComputationError(
                f"{settings.type}: {settings.max_steps} steps were not enough "
                f"(analysis.max_steps), the run stands at {last.time:g} s"
            )
        last = _next(problem, settings, steady, sizes, targets[0], last)
        if last.time == targets[0]:
            targets.pop(0)
        yield last


def is_over(settings: TimedAnalysis, problem: WearProblem, last: Moment) -> bool:
    """Test whether the running-in ends with this state."""
    end = times_to_hit(settings, problem)[-1]
    return last.time >= end or _is_steady(settings, last.distance)


def _first(problem: WearProblem, steady: np.ndarray | None) -> Moment:
    """Initial state: the unworn contact at time 0."""
    state = problem.start()
    distance, wanted = problem.distance(state, steady), problem.first_step(state)
    return Moment(0.0, 0.0, state, 0.0, False, distance, 0, 0.0, wanted)


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

    Returns
    -------
    trial : TrialStep
    step, following : float
        Size of the step, and of the next one as proposed by error control [s].
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
    return sorted({*settings.output_times, *corners, end})


def _is_steady(settings: TimedAnalysis, distance: float) -> bool:
    return settings.until == "steady" and distance <= settings.steady_tolerance
