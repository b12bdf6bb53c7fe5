"""One implicit step of wear and the error it makes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .interface_problem import Contact

_γ = 1 - 1 / np.sqrt(2)


class WearProblem(Protocol):
    """Contact of bodies that wear: in place, or averaged over a cycle.

    Depths have shape (n_rows, n); what they open is their sum over the rows.
    """

    def unworn(self) -> Contact:
        """Contact of the unworn faces."""

    def rates(self, pressure: np.ndarray) -> np.ndarray:
        """Wear rates of the depths [m/s]."""

    def solve(self, worn: np.ndarray, step: float, guess: Contact, closed: np.ndarray) -> Contact:
        """Contact at the end of an implicit step of wear, from the sum of the depths before."""

    def steady(self, pressure: np.ndarray) -> np.ndarray:
        """Steady pressure of the discrete interface [Pa]."""

    def distance(self, pressure: np.ndarray, steady: np.ndarray | None) -> float:
        """How far from the steady state; NaN where that is not known."""

    def deflection(self, contact: Contact) -> float:
        """Largest change of the gap by the bodies' deformation [m]."""


_ROUNDING = 1e-13  # of the largest pressure so far: no step makes smaller errors


@dataclass(frozen=True)
class WornContact:
    """State of a running-in.

    Attributes
    ----------
    worn : ndarray, shape (n_wearing, n)
        Depths worn off [m].
    contact : Contact
    peak : float
        Largest pressure before [Pa].
    """

    worn: np.ndarray
    contact: Contact
    peak: float = 0.0

    @property
    def pressure(self) -> np.ndarray:
        """At the points, shape (n,) [Pa]."""
        return self.contact.pressure

    @property
    def largest(self) -> float:
        """Pressure so far [Pa]."""
        return max(self.peak, float(self.pressure.max()))


def advance(problem: WearProblem, state: WornContact, step: float) -> WornContact:
    """One step of the two-stage, second-order, L-stable diagonally implicit Runge-Kutta method.

    It is stiffly accurate, so the contact conditions hold at the end of the step, and its weights
    are positive, so wear never goes back (Alexander, SIAM J. Numer. Anal. 14 (1977) 1006).
    """
    closed = state.pressure > 0
    first = problem.solve(state.worn.sum(axis=0), _γ * step, state.contact, closed)
    rates = problem.rates(first.pressure)
    before = state.worn + (1 - _γ) * step * rates
    last = problem.solve(before.sum(axis=0), _γ * step, first, closed)
    worn = before + _γ * step * problem.rates(last.pressure)
    return WornContact(worn, last, state.largest)


def advance_with_error(
    problem: WearProblem, state: WornContact, step: float
) -> tuple[WornContact, float]:
    """Two half steps, and their error from the difference to a whole one (Richardson).

    Returns
    -------
    WornContact
        After the two half steps.
    float
        Larger of the errors of pressure and of wear, relative to the largest pressure and to the
        largest depth worn so far. What rounding makes of a pressure that vanishes in the end is
        no error of the step.
    """
    whole = advance(problem, state, step)
    halves = advance(problem, advance(problem, state, step / 2), step / 2)
    rounding = _ROUNDING * halves.largest
    scale = max(float(halves.pressure.max()), rounding)
    pressure_error = _relative(halves.pressure - whole.pressure, scale, rounding)
    wear_error = _relative(halves.worn - whole.worn, float(halves.worn.max()))
    return halves, max(pressure_error, wear_error) / 3.0


def _relative(errors: np.ndarray, scale: float, allowed: float = 0.0) -> float:
    """By how much the largest exceeds what is allowed, against a scale; 0 where nothing does."""
    largest = float(np.abs(errors).max()) - allowed
    return largest / scale if largest > 0.0 else 0.0


def next_step(step: float, error: float, tolerance: float) -> float:
    """Step size that should meet the tolerance; the error goes with its third power."""
    if error == 0.0:
        return 5.0 * step
    return step * float(np.clip(0.9 * (tolerance / error) ** (1 / 3), 0.2, 5.0))
