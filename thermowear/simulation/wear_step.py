"""One implicit step of wear and the error it makes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .interface_problem import Contact, InterfaceProblem

_γ = 1 - 1 / np.sqrt(2)


@dataclass(frozen=True)
class WornContact:
    """State of a running-in.

    Attributes
    ----------
    worn : ndarray, shape (n_wearing, n)
        Depths worn off [m].
    contact : Contact
    """

    worn: np.ndarray
    contact: Contact

    @property
    def pressure(self) -> np.ndarray:
        """At the points, shape (n,) [Pa]."""
        return self.contact.pressure


def advance(problem: InterfaceProblem, state: WornContact, step: float) -> WornContact:
    """One step of the two-stage, second-order, L-stable diagonally implicit Runge-Kutta method.

    It is stiffly accurate, so the contact conditions hold at the end of the step, and its weights
    are positive, so wear never goes back (Alexander, SIAM J. Numer. Anal. 14 (1977) 1006).
    """
    closed = state.pressure > 0
    first = problem.solve(state.worn.sum(axis=0), _γ * step, state.contact, closed)
    rates = problem.rates(first.pressure)
    before = state.worn + (1 - _γ) * step * rates
    last = problem.solve(before.sum(axis=0), _γ * step, first, closed)
    return WornContact(before + _γ * step * problem.rates(last.pressure), last)


def advance_with_error(
    problem: InterfaceProblem, state: WornContact, step: float
) -> tuple[WornContact, float]:
    """Two half steps, and their error from the difference to a whole one (Richardson).

    Returns
    -------
    WornContact
        After the two half steps.
    float
        Larger of the errors of pressure and of wear, relative to the largest pressure and to the
        largest depth worn so far.
    """
    whole = advance(problem, state, step)
    halves = advance(problem, advance(problem, state, step / 2), step / 2)
    pressure_error = np.abs(halves.pressure - whole.pressure).max() / halves.pressure.max()
    wear_error = np.abs(halves.worn - whole.worn).max() / halves.worn.max()
    return halves, float(max(pressure_error, wear_error)) / 3.0


def next_step(step: float, error: float, tolerance: float) -> float:
    """Step size that should meet the tolerance; the error goes with its third power."""
    if error == 0.0:
        return 5.0 * step
    return step * float(np.clip(0.9 * (tolerance / error) ** (1 / 3), 0.2, 5.0))
