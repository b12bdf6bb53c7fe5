"""Conversion of Python arguments to laws: laws, numbers, or plain functions of arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .coefficients.constant import Constant
from .formulas import FormulaLaw, FormulaWear
from .interfaces import INTERFACE_VARIABLES, WEAR_VARIABLES, InterfaceLaw, WearRate
from .plain_function import PlainFunction
from .plausible import require_wear_rate


def wear_rate(given: WearRate | Callable[..., np.ndarray]) -> WearRate:
    """Wear rate from a law, or from a function of some of ``p, v, T, depth, mu`` [m/s].

    Raises
    ------
    ValueError
        If the rate is negative or falls with the pressure.
    CaseError
        If the function has other parameters, or returns no array of their shape.
    """
    law: Any = given
    if not hasattr(given, "rate"):
        law = FormulaWear(PlainFunction.of(law, WEAR_VARIABLES), getattr(given, "__name__", "law"))
    require_wear_rate(law)
    return law


def interface_law(given: InterfaceLaw | float | Callable[..., np.ndarray]) -> InterfaceLaw:
    """Friction or conductance from a law, a number, or a function of some of ``p, v, T``.

    Raises
    ------
    CaseError
        If the function has other parameters.
    """
    law: Any = given
    if isinstance(given, int | float):
        return Constant(float(given))
    if hasattr(given, "value"):
        return law
    return FormulaLaw(PlainFunction.of(law, INTERFACE_VARIABLES), getattr(given, "__name__", "law"))
