"""Running-in: contact, heat and wear in time, to an end time or to the steady state."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..case.analyses import Timed
from ..errors import ComputationError
from .interface_problem import Contact
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


def moments(problem: WearProblem, settings: Timed, steady: np.ndarray | None) -> Iterator[Moment]:
    """The moments of a running-in, from the unworn contact on.

    Parameters
    ----------
    problem : WearProblem
    settings : Transient
    steady : ndarray or None, shape (n,)
        Steady pressure from the principle [Pa]; None without one (a given approach).

    Raises
    ------
    ComputationError
        If the step has become too small or the steps too many. What was yielded stays valid.
    """
    contact = problem.unworn()
    rates = problem.rates(contact.pressure)
    state = WornContact(np.zeros_like(rates), contact)
    steady = None if steady is None else problem.steady(steady)
    distance = problem.distance(state.pressure, steady)
    time, step = 0.0, _first_step(problem, contact, rates)
    targets = _targets(settings)
    yield Moment(0.0, 0.0, state, 0.0, False, distance)
    for _ in range(settings.max_steps):
        if not targets or _is_steady(settings, distance):
            return
        planned = step
        time_left = targets[0] - time
        hits = planned >= time_left * (1 - 1e-9)
        step = time_left if hits else min(planned, max(time_left / 2, 0.1 * planned))
        state, step, error, hits, following = _accept(problem, state, step, hits, time, settings)
        time = targets[0] if hits else time + step
        distance = problem.distance(state.pressure, steady)
        reached = targets.pop(0) if hits else None
        yield Moment(time, step, state, error, reached in settings.output_times, distance)
        step = max(following, planned) if hits else following
    if targets and not _is_steady(settings, distance):
        raise ComputationError(
            f"{settings.type}: {settings.max_steps} steps were not enough (analysis.max_steps), "
            f"the run stands at {time:g} s"
        )


def _accept(problem, state, step, hits, time, settings):
    """Repeat a step with smaller sizes until its error is within the tolerance."""
    trouble = ""
    while step > _SMALLEST * max(time, _SMALLEST):
        try:
            following, error = advance_with_error(problem, state, step)
        except ComputationError as failure:
            step, hits, trouble = step / 4, False, f" ({failure})"
            continue
        proposed = next_step(step, error, settings.tolerance)
        if error <= settings.tolerance:
            return following, step, error, hits, proposed
        step, hits = min(proposed, 0.9 * step), False
    raise ComputationError(f"{settings.type}: no step is small enough at {time:g} s{trouble}")


def _targets(settings: Timed) -> list[float]:
    """Times that must be hit exactly, in order; the last one ends the run."""
    end = np.inf if settings.end_time is None else settings.end_time
    return sorted({*settings.output_times, end})


def _is_steady(settings: Timed, distance: float) -> bool:
    return settings.until == "steady" and distance <= settings.steady_tolerance


def _first_step(problem: WearProblem, contact: Contact, rates: np.ndarray) -> float:
    """A step in which wear is small against the elastic deflection of the bodies."""
    fastest = float(rates.sum(axis=0).max())
    return 1e-3 * problem.deflection(contact) / fastest if fastest > 0.0 else np.inf
