"""Functions that expressions may call, with their derivatives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Pointwise = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Function:
    """Function of one variable.

    Attributes
    ----------
    value, slope : callable
        Function and derivative, elementwise.
    power : float or None
        Exponent of the unit of the argument in that of the value; None if both are dimensionless.
    """

    value: Pointwise
    slope: Pointwise
    power: float | None = None


FUNCTIONS = {
    "exp": Function(np.exp, np.exp),
    "log": Function(np.log, lambda x: 1 / x),
    "log10": Function(np.log10, lambda x: 1 / (x * np.log(10.0))),
    "sqrt": Function(np.sqrt, lambda x: 0.5 / np.sqrt(x), power=0.5),
    "abs": Function(np.abs, np.sign, power=1.0),
    "tanh": Function(np.tanh, lambda x: 1 - np.tanh(x) ** 2),
    "sin": Function(np.sin, np.cos),
    "cos": Function(np.cos, lambda x: -np.sin(x)),
}
EXTREMES = {"min": np.less_equal, "max": np.greater_equal}
"""Functions of several arguments of equal dimension, with the comparison that keeps the first."""
KNOWN = (*FUNCTIONS, *EXTREMES)
