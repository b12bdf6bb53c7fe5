"""One implicit step of wear and the error it makes."""

from __future__ import annotations

import numpy as np

from .interface_problem import InterfaceProblem, WornContact

_γ = 1 - 1 / np.sqrt(2)


def advance(problem: InterfaceProblem, state: WornContact, step: float) -> WornContact:
    """One step of the two-stage, second-order, L-stable diagonally implicit Runge-Kutta method.

    It is stiffly accurate, so the contact conditions hold at the end of the step, and its weights
    are positive, so wear never goes back (Alexander, SIAM J. Numer. Anal. 14 (1977) 1006).
    """
    closed = state.pressure > 0
    first = problem.solve(state.worn.sum(axis=0), _γ * step, state.solution, closed)
    rates = problem.rates(problem.pressure(first))
    before = state.worn + (1 - _γ) * step * rates
    solution = problem.solve(before.sum(axis=0), _γ * step, first, closed)
    pressure = problem.pressure(solution)
    worn = before + _γ * step * problem.rates(pressure)
    return WornContact(worn, solution, pressure)


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
