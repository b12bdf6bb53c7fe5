"""Time loop of contact, heat and wear with step control, to an end time or to the steady state.

With a conductance that jumps where points touch, faces in steady heat flow may be hot enough to
touch while apart, and too cold while they touch: neither is a solution (Barber, J. Elasticity 8
(1978) 409). In time both then alternate.

Given steps, such as those of an earlier run, are taken without error control.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np

from ..errors import ComputationError, StandstillError
from ..model.analyses import TimedAnalysis
from ..serialise import serialisable
from .interface.sdirk import (
    InterfaceState,
    TrialStep,
    WearProblem,
    advance_with_error,
    advance_without_error,
)

STEPS = 100
"""Number of steps after which alternation is looked for again."""
_TURNS = 30
"""Number of turns among the last steps from which a quantity alternates; others turn rarely."""

ALTERNATES = (
    "the edge of the contact alternates between open and closed, as the conductance of the faces "
    "jumps there; steps are small. A heat.conductance that vanishes with the pressure, such as "
    '"1e5 W/(m^2 K) * p/(1 MPa)", avoids that'
)


def alternates(values: Sequence[float]) -> bool:
    """True if a quantity alternates in its last `STEPS` values."""
    last = values[-STEPS:]
    changes = [after > before for before, after in pairwise(last) if after != before]
    return sum(a != b for a, b in pairwise(changes)) >= _TURNS


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


_FAR_SMALLER = 1e-3
"""Size ratio of trial steps for detecting jumps: time errors fall at least by its square root."""
_SMALLEST = 1e-12  # relative to the elapsed time; at the start to 1e-12 s
_HIT = 1e-9
"""Distance to a target time, relative to the time left, at which a step is taken to end there."""
_ON_GRID = 1e3
"""Least step on the grid of steps, relative to the rounding of times: no other time lies there."""
_FEW = 5
"""Largest number of powers of two that make up an interval; bounds the number of small steps."""
_STEPS_OF_SIZE = 1024
"""Number of sizes of steps up to a power of two, a half of them above the one before."""
_ROUNDING, _STILL = 1e-9, 20
"""Error and number of successive steps, ever larger ones, in which nothing changes any more."""


class StepSizes(ABC):
    """Choice of step sizes between two consecutive times that must be hit exactly.

    Parameters
    ----------
    largest : float, optional
        Upper bound, which may change from step to step [s].

    Attributes
    ----------
    rounding : float
        Largest ratio of a wanted step size to the one chosen.
    """

    rounding = 1.0

    def __init__(self, largest: float = math.inf):
        self.largest = largest

    @abstractmethod
    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        """Step from a time between begin and end, not larger than the wanted one [s]."""

    def nominal(self, step: float, begin: float, end: float) -> float:
        """Size of an earlier step between begin and end, without the rounding of its times [s]."""
        return step

    def begin(self, time: float, begin: float, end: float) -> float:
        """Time from which steps count that lead from a time after begin to an end [s]."""
        return begin


class AnySize(StepSizes):
    """Largest admissible steps of few digits that do not leave a tiny last one.

    Errors of steps in which points begin to press depend strongly on the size, and the next size on
    the error: rounding that reached the sizes would grow from step to step.
    """

    rounding = 1 + 2 / _STEPS_OF_SIZE

    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        mantissa, exponent = math.frexp(wanted)
        if math.isfinite(wanted):
            wanted = math.ldexp(math.floor(mantissa * _STEPS_OF_SIZE) / _STEPS_OF_SIZE, exponent)
        left, wanted = end - time, min(wanted, self.largest)
        return left if ends(wanted, left) else min(wanted, max(left / 2, 0.1 * wanted))


class FewSizes(StepSizes):
    """Power-of-two multiples of one step size, so that few operators serve all steps.

    Each step begins at a multiple of its size (dyadic grid): the time left to the next target is
    always a sum of few such steps.

    Parameters
    ----------
    times : iterable of float
        All times that must be hit exactly [s].
    """

    rounding = 2.0

    def __init__(self, times: Iterable[float]):
        super().__init__()
        self._measure = _common_measure(sorted(t for t in times if 0.0 < t < math.inf))

    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        wanted = min(wanted, self.largest, end - time + _rounding(end))
        return _on_grid(wanted, self._unit(begin, end), begin, time)

    def nominal(self, step: float, begin: float, end: float) -> float:
        unit = self._unit(begin, end)
        size = unit * 2.0 ** round(math.log2(step / unit))
        return size if abs(size - step) <= _HIT * step + _rounding(end) else step

    def begin(self, time: float, begin: float, end: float) -> float:
        passed = time - begin
        on_grid = passed <= 0 or _on_grid(passed, self._unit(begin, end), begin, time) > (
            _ON_GRID * ROUNDED * time
        )
        return begin if on_grid else time

    def _unit(self, begin: float, end: float) -> float:
        """Unit of the step sizes: common measure of all times, or the interval if too fine [s]."""
        interval, measure = end - begin, self._measure
        if interval == math.inf:
            return measure or 1.0
        count = round(interval / measure) if measure else 0
        fits = count > 0 and abs(count * measure - interval) <= _rounding(end)
        return measure if fits and count.bit_count() <= _FEW else interval


def ends(step: float, left: float, end: float = 0.0) -> bool:
    """Test whether a step covers the time left, up to rounding of it and of the end [s]."""
    return step >= left * (1 - _HIT) - _rounding(end)


def _rounding(end: float) -> float:
    """Rounding of the times up to an end [s]."""
    return 0.0 if end == math.inf else ROUNDED * end


def _on_grid(largest: float, unit: float, begin: float, time: float) -> float:
    """Largest power-of-two multiple of a unit, a multiple of which lies between two times [s]."""
    size = unit * 2.0 ** math.floor(math.log2(largest / unit) + _HIT)
    while abs(math.remainder(time - begin, size)) > ROUNDED * time:
        size /= 2
    return size


def _common_measure(times: Sequence[float]) -> float:
    """Time [s] of which all increasing times are multiples up to their rounding; 0 without one.

    By Euclid's algorithm, whose rounding errors the ratio to the last time corrects.
    """
    if not times:
        return 0.0
    measure, rounding = 0.0, _HIT * times[-1]
    for time in times:
        while time > rounding:
            measure, time = time, abs(math.remainder(measure, time))
    measure = times[-1] / round(times[-1] / measure)
    fits = (is_same(time, measure * round(time / measure)) for time in times)
    return measure if all(fits) else 0.0


def next_step(
    step: float,
    error: float,
    tolerance: float,
    former: tuple[float, float] | None = None,
    wanted: float = 0.0,
) -> float:
    """Step size expected to meet the tolerance; the error is of third order in the step.

    Slower growth of the error from the former step to this one is extrapolated to the next
    (predictive control, Gustafsson, ACM Trans. Math. Softw. 20 (1994) 496).

    Parameters
    ----------
    step, error, tolerance : float
    former : tuple of float, optional
        Size and error of the preceding step; no prediction without them.
    wanted : float, optional
        Size that this step would have had, had nothing but its error limited it.
    """
    most = max(5.0, wanted / step)
    if error == 0.0:
        return most * step
    factor = 0.9 * (tolerance / error) ** (1 / 3)
    if former is not None and factor > 1.0:
        factor *= max(1.0, step / former[0] * (former[1] / error) ** (1 / 3))
    return step * float(np.clip(factor, 0.2, most))


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
        If steps become too many, or too small (`StandstillError`). Yielded states stay valid.
    """
    sizes = sizes or AnySize()
    if last is None:
        state = problem.start()
        distance, wanted = problem.distance(state, steady), problem.first_step(state)
        last = Moment(0.0, 0.0, state, 0.0, False, distance, 0, 0.0, wanted)
        yield last
    times = times_to_hit(settings, problem)
    targets = [time for time in times if time > last.time and not is_same(time, last.time)]
    require_valid(settings, times)
    steps, still = _Steps(problem, settings, steady, sizes), 0
    while not is_over(settings, last):
        if last.number == settings.max_steps and not settings.steps:
            raise ComputationError(
                f"{settings.type}: {settings.max_steps} steps were not enough "
                f"(analysis.max_steps), the run stands at {last.time:g} s"
            )
        last = steps.next(targets[0], last)
        if last.time == targets[0]:
            targets.pop(0)
        yield last
        still = still + 1 if last.error <= _ROUNDING else 0
        if still == _STILL and targets == [math.inf]:
            raise StandstillError(
                f"{settings.type}: nothing changes any more at {last.time:.4g} s, at a distance of "
                f"{last.distance:.2g} from the steady state (analysis.steady_tolerance = "
                f"{settings.steady_tolerance:g}); use a finer mesh, or a larger tolerance"
            )


def is_over(settings: TimedAnalysis, last: Moment) -> bool:
    """Test whether the running-in ends with this state."""
    if settings.steps:
        return last.number == len(settings.steps)
    end = max((settings.end_time, *settings.output_times))
    return is_steady(settings, last.distance) or last.time >= end or is_same(last.time, end)


def is_steady(settings: TimedAnalysis, distance: float) -> bool:
    """Test for the steady state; for one near it with steps of a run with other parameters."""
    most = settings.steady_tolerance * (2 if settings.steps else 1)
    return settings.until == "steady" and distance <= most


@dataclass(frozen=True)
class _Steps:
    """Steps of a running-in towards a target time that must be hit exactly [s]."""

    problem: WearProblem
    settings: TimedAnalysis
    steady: object
    sizes: StepSizes

    def next(self, target: float, last: Moment) -> Moment:
        """Given step, or one by error control."""
        last = replace(last, begin=self.sizes.begin(last.time, last.begin, target))
        return (self._given if self.settings.steps else self._controlled)(target, last)

    def _given(self, target: float, last: Moment) -> Moment:
        """Given step, without error control, before or up to the target time."""
        time = self.settings.steps[last.number]
        time = target if is_same(time, target) else time
        step = self.sizes.nominal(time - last.time, last.begin, target)
        try:
            state = advance_without_error(self.problem, last.state, last.time, step)
        except ComputationError as failure:
            raise ComputationError(
                f"{self.settings.type}: the given step from {last.time:g} to {time:g} s failed "
                f"({failure})"
            ) from None
        return self._moment(last, target, state, time=time, step=step, error=math.nan, wanted=step)

    def _controlled(self, target: float, last: Moment) -> Moment:
        """Step whose error is within the tolerance."""
        size = partial(self.sizes.at_most, time=last.time, begin=last.begin, end=target)
        smallest = _SMALLEST * max(last.time, min(_SMALLEST, target))  # a first target may be tiny
        trial, step, following = self._accept(last, size, smallest)
        hits = ends(step, target - last.time, target)
        time = target if hits else last.time + step
        wanted = max(following, last.wanted) if hits else following
        own = {"time": time, "step": step, "error": trial.error, "wanted": wanted}
        return self._moment(last, target, trial.state, **own)

    def _moment(self, last: Moment, target: float, state: InterfaceState, **own: float) -> Moment:
        """Accepted state after the last one, with its own time, step, error and next step."""
        return Moment(
            state=state,
            is_output=any(is_same(own["time"], time) for time in self.settings.output_times),
            distance=self.problem.distance(state, self.steady),
            number=last.number + 1,
            begin=target if own["time"] == target else last.begin,
            **own,
        )

    def _accept(self, last: Moment, size, smallest: float) -> tuple[TrialStep, float, float]:
        """Repeat a step with smaller sizes until its error is within the tolerance.

        Step sizes that must end behind an event are increased to do so once rounded.

        With pointwise contact, an error that does not decrease in a far smaller step is a jump: a
        point begins to press suddenly. That step, which ends right behind the event, is accepted.

        Returns the step, its size, and that of the next one as proposed by error control [s].
        """
        tolerance, rounding = self.settings.tolerance, self.sizes.rounding
        trouble, step = "", size(last.wanted)
        # errors decrease steadily while the transient after a point begins to press decays
        former = None if last.state.pointwise is None else (last.step, last.error)
        tried: list[tuple[float, float]] = []
        while step > smallest:
            try:
                trial = advance_with_error(self.problem, last.state, last.time, step)
            except ComputationError as failure:
                step, trouble = size(step / 4), f" ({failure})"
                continue
            error = trial.error
            proposed = next_step(step, error, tolerance, former, last.wanted)
            if error <= tolerance:
                return trial, step, min(proposed, rounding * trial.following)
            jumps = any(
                step <= _FAR_SMALLER * tried_size and error > e / 2 for tried_size, e in tried
            )
            if jumps and trial.state.pointwise is not None:
                return trial, step, step / _FAR_SMALLER
            tried.append((step, error))
            located = rounding * trial.reached if trial.reached < 0.9 * step else 0.0
            step = size(min(max(proposed, located), 0.9 * step))
        raise StandstillError(
            f"{self.settings.type}: no step is small enough at {last.time:g} s{trouble}"
        )


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
