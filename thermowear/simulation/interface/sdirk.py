"""One implicit step of wear and the error it makes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ...contact.operators.heat import ThermalState
from ...serialise import serialisable
from ..heat.heat_states import StoredHeat
from .contact_solver import ContactSolution

_γ = 1 - 1 / np.sqrt(2)


_ROUNDING = 1e-13  # of the largest pressure so far: no step makes smaller errors
_LEAST_RISE = 10.0  # K; errors of smaller rises are held against this one


@serialisable
@dataclass(frozen=True)
class InterfaceState:
    """State of a running-in.

    Attributes
    ----------
    worn : ndarray, shape (n_wearing, n)
        Depths worn off [m].
    contact : ContactSolution
    peak : float
        Largest pressure before [Pa].
    faces : ThermalState or None
        Temperatures and fluxes of the faces; None without heat.
    stored : StoredHeat or None
        None where temperatures are those of a steady state at any time.
    pointwise : ndarray of bool or None, shape (n,)
        Points at which contact holds one by one, at the edge of the wear, see `contact.wear_edge`.
    """

    worn: np.ndarray
    contact: ContactSolution
    peak: float = 0.0
    faces: ThermalState | None = None
    stored: StoredHeat | None = None
    pointwise: np.ndarray | None = None

    @property
    def pressure(self) -> np.ndarray:
        """At the points, shape (n,) [Pa]."""
        return self.contact.pressure

    @property
    def largest(self) -> float:
        """Pressure so far [Pa]."""
        return max(self.peak, float(self.pressure.max()))

    def towards(self, other: InterfaceState, part: float) -> InterfaceState:
        """What accumulates moved on by a part of the way to another state."""
        stored = self.stored
        if stored is not None and other.stored is not None:
            stored = stored.towards(other.stored, part)
        worn = self.worn + part * (other.worn - self.worn)
        return InterfaceState(
            worn, other.contact, self.largest, other.faces, stored, self.pointwise
        )


class WearProblem(Protocol):
    """Contact of bodies that wear: in place, or averaged over a cycle.

    Depths have shape (n_rows, n); what they open is their sum over the rows.
    """

    def start(self) -> InterfaceState:
        """The unworn faces, at time 0."""

    def begin(self, state: InterfaceState) -> InterfaceState:
        """A state with what is chosen anew for each step, the same for all that it is made of."""

    def stage(
        self, before: InterfaceState, step: float, time: float, guess: InterfaceState
    ) -> InterfaceState:
        """The end of an implicit Euler step.

        Parameters
        ----------
        before : InterfaceState
            What has accumulated before the step.
        step, time : float
            Its size and its end [s].
        guess : InterfaceState
            A state near to the result.

        Raises
        ------
        ComputationError
        """

    def difference(
        self, before: InterfaceState, one: InterfaceState, other: InterfaceState
    ) -> float:
        """Difference of two pressures, the largest one where they are continuous in time [Pa].

        Parameters
        ----------
        before : InterfaceState
            At the beginning of the step.
        one, other : InterfaceState
            At its end; all of the pressure where what was chosen for the step does not do for them.
        """

    def edge_steps(
        self,
        states: tuple[InterfaceState, InterfaceState, InterfaceState],
        step: float,
        time: float,
    ) -> tuple[float, float]:
        """Steps that end right behind a time at which the edge of the wear reaches a point.

        Parameters
        ----------
        states : tuple of InterfaceState
            At the beginning of a step, in its middle and at its end.
        step, time : float
            Its size and its end [s].

        Returns
        -------
        reached : float
            In place of this step, to the first point that it has reached; 0 without any [s].
        following : float
            The largest that may follow this step; may be infinite [s].
        """

    def difference_inside(self, one: InterfaceState, other: InterfaceState) -> float:
        """Largest difference of temperatures inside the bodies, where that matters [K]."""

    def corners(self, end: float) -> tuple[float, ...]:
        """Times up to an end that steps must not pass over [s]."""

    def first_step(self, state: InterfaceState) -> float:
        """A step to begin with [s]; may be infinite."""

    def steady(self, steady) -> np.ndarray:
        """Pressure of the discrete interface in a steady state [Pa]."""

    def distance(self, state: InterfaceState, steady: np.ndarray | None) -> float:
        """How far from the steady state; NaN where that is not known."""


def advance(
    problem: WearProblem, state: InterfaceState, time: float, step: float
) -> InterfaceState:
    """One step of the two-stage, second-order, L-stable diagonally implicit Runge-Kutta method.

    It is stiffly accurate, so the contact conditions hold at the end of the step, and its weights
    are positive, so wear never goes back (Alexander, SIAM J. Numer. Anal. 14 (1977) 1006). Both
    stages are implicit Euler steps of the size γ step.
    """
    first = problem.stage(state, _γ * step, time + _γ * step, state)
    before = state.towards(first, (1 - _γ) / _γ)
    return replace(problem.stage(before, _γ * step, time + step, first), peak=state.largest)


@dataclass(frozen=True)
class TrialStep:
    """A step that has been tried.

    Attributes
    ----------
    state : InterfaceState
        At its end.
    error : float
    reached, following : float
        See `WearProblem.edge_steps` [s].
    """

    state: InterfaceState
    error: float
    reached: float = 0.0
    following: float = np.inf


def advance_with_error(
    problem: WearProblem, state: InterfaceState, time: float, step: float
) -> TrialStep:
    """Two half steps, and their error from the difference to a whole one (Richardson).

    Returns
    -------
    TrialStep
        The state after the two half steps. Its error is the largest of those of pressure (see
        `WearProblem.difference`), of wear, and of
        temperatures that are followed in time: relative to the largest pressure, to the largest
        depth worn and to the largest rise so far, 10 K at least. Temperatures are those of the
        faces, and those inside the bodies where not friction alone heats them. What rounding makes
        of a pressure that vanishes in the end is no error of the step.
    """
    # the same points for the whole step and for its halves: what moves on is no error of time
    state = problem.begin(state)
    whole = advance(problem, state, time, step)
    middle = advance(problem, state, time, step / 2)
    halves = advance(problem, middle, time + step / 2, step / 2)
    rounding = _ROUNDING * halves.largest
    scale = max(float(halves.pressure.max()), rounding)
    errors = [
        _relative(problem.difference(state, halves, whole), scale, rounding),
        _relative(halves.worn - whole.worn, float(halves.worn.max(initial=0.0))),
    ]
    if halves.stored is not None and halves.faces is not None and whole.faces is not None:
        largest = max(halves.stored.largest, _LEAST_RISE)
        errors += [
            _relative(ours - theirs, largest)
            for ours, theirs in zip(halves.faces.rise, whole.faces.rise, strict=True)
        ]
        errors.append(problem.difference_inside(halves, whole) / largest)
    edge = problem.edge_steps((state, middle, halves), step, time + step)
    return TrialStep(halves, max(errors) / 3.0, *edge)


def _relative(errors: np.ndarray | float, scale: float, allowed: float = 0.0) -> float:
    """By how much the largest exceeds what is allowed, against a scale; 0 where nothing does."""
    largest = float(np.abs(errors).max(initial=0.0)) - allowed
    return largest / scale if largest > 0.0 else 0.0


def next_step(
    step: float, error: float, tolerance: float, former: tuple[float, float] | None = None
) -> float:
    """Step size that should meet the tolerance; the error goes with its third power.

    Where it has grown less than that from the former step to this one, it is expected to do so
    again (predictive control, Gustafsson, ACM Trans. Math. Softw. 20 (1994) 496).

    Parameters
    ----------
    step, error, tolerance : float
    former : tuple of float, optional
        Size and error of the step that led to this one; without them no more is expected.
    """
    if error == 0.0:
        return 5.0 * step
    factor = 0.9 * (tolerance / error) ** (1 / 3)
    if former is not None and factor > 1.0:
        factor *= max(1.0, step / former[0] * (former[1] / error) ** (1 / 3))
    return step * float(np.clip(factor, 0.2, 5.0))
