"""Conversion of Python arguments to laws: laws, numbers, or plain functions of arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .coefficients import Constant
from .formulas import FormulaLaw, FormulaWear
from .interfaces import Law
from .plain_function import PlainFunction
from .plausible import require_wear_rate


def wear_rate(given: Law | Callable[..., np.ndarray]) -> Law:
    """Wear rate from a law, or from a function of some of ``p, v, T, depth, mu`` [m/s].

    Raises
    ------
    ValueError
        If the rate is negative or falls with the pressure.
    CaseError
        If the function has other parameters, or returns no array of their shape.
    """
    law = _law(given, FormulaWear)
    require_wear_rate(law)
    return law


def interface_law(given: Law | float | Callable[..., np.ndarray]) -> Law:
    """Friction or conductance from a law, a number, or a function of some of ``p, v, T``.

    Raises
    ------
    CaseError
        If the function has other parameters.
    """
    return Constant(float(given)) if isinstance(given, int | float) else _law(given, FormulaLaw)


def _law(given: Any, kind: type[FormulaLaw]) -> Law:
    if hasattr(given, "value"):
        return given
    return kind(PlainFunction.of(given, kind.NAMES), getattr(given, "__name__", "law"))
