"""Newton's method for contact with wear in an implicit step.

The depth worn in the step is that of the pressure at its end. It is linearised in the pressure, so
that each iteration is a contact problem with an additional compliance. An iterate is damped by half
if the error of its linearisation has not decreased.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar

import numpy as np

from ...errors import ComputationError

_STEPS = 40
_TOLERANCE = 1e-11
_FAILED = "contact: Newton's method for the implicit step of wear did not converge"


Solution = TypeVar("Solution", bound=Any)
"""Solution of a contact problem, with its `pressure`, or coefficients of it [Pa]."""


class PressureDependentWear(Protocol):
    """Wear as a function of the pressure at the end of a step: depths, or rates.

    It may also depend on the last contact solution, which is not linearised.
    """

    def value(self, pressure: np.ndarray, last: Any) -> np.ndarray:
        """Worn depth [m], or wear rate [m/s]."""

    def slope(self, pressure: np.ndarray, last: Any) -> Any:
        """Derivative of the value, a linear map ``slope @ pressure``."""


def newton_with_wear(
    solve: Callable[[np.ndarray, Any, Solution], Solution],
    wear: PressureDependentWear,
    guess: Solution,
    tolerance: float = _TOLERANCE,
    failure: str = _FAILED,
) -> Solution:
    """Solve contact with pressure-dependent wear in an implicit step by Newton's method.

    Parameters
    ----------
    solve : callable
        Contact for linearised wear (its value at zero pressure, its slope) and a guess.
    wear : PressureDependentWear
    guess : object
        Contact solution with a pressure.
    tolerance : float, optional
        Error of the linearised wear, relative to its largest value.
    failure : str, optional
        Message of the error.

    Raises
    ------
    ComputationError
        If the iteration does not converge.
    """
    pressure, least = guess.pressure, np.inf
    for _ in range(_STEPS):
        value, slope = wear.value(pressure, guess), wear.slope(pressure, guess)
        guess = solve(value - slope @ pressure, slope, guess)
        exact = wear.value(guess.pressure, guess)
        error = np.abs(exact - value - slope @ (guess.pressure - pressure)).max()
        if error <= tolerance * np.abs(exact).max():
            return guess
        back = 0.0 if error < least else 0.5
        pressure, least = back * pressure + (1 - back) * guess.pressure, min(error, least)
    raise ComputationError(failure)
