"""Laws by a formula: an expression of the case file, a plain function of arrays, or a number."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..errors import ComputationError
from .coefficients import Constant
from .interfaces import INTERFACE_VARIABLES, UNITS, WEAR_VARIABLES, Formula, Law, LocalState
from .plain_function import PlainFunction
from .plausible import require_wear_rate
from .power_wear import floored


@dataclass(frozen=True)
class FormulaLaw:
    """Coefficient of friction, or conductance, by a formula.

    Attributes
    ----------
    formula : Formula
        Value in the variables of `NAMES`.
    name : str
        Name of the law, for messages.
    least : float
        Smallest valid value.
    """

    NAMES: ClassVar[tuple[str, ...]] = INTERFACE_VARIABLES

    formula: Formula
    name: str = "coefficient"
    least: float = -np.inf

    @property
    def variables(self) -> frozenset[str]:
        """Variables of the formula."""
        return self.formula.variables

    def value(self, at: LocalState) -> np.ndarray:
        """Value at points (n,)."""
        arrays = at.arrays(self.NAMES)
        return required(self.name, self.formula.value(arrays), arrays, self.least)

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure."""
        arrays = at._replace(p=floored(at.p)).arrays(self.NAMES)
        return required(f"derivative of the {self.name}", self.formula.slope(arrays, "p"), arrays)


@dataclass(frozen=True)
class FormulaWear(FormulaLaw):
    """Wear rate by a formula [m/s]; 0 or more, and evaluated at nonnegative pressures only."""

    NAMES: ClassVar[tuple[str, ...]] = WEAR_VARIABLES

    name: str = "wear rate"
    least: float = 0.0

    def value(self, at: LocalState) -> np.ndarray:
        """Depth worn per time at points (n,) [m/s]."""
        return super().value(at._replace(p=np.maximum(at.p, 0.0)))


def required(
    name: str, found: np.ndarray, at: dict[str, np.ndarray], least: float = -np.inf
) -> np.ndarray:
    """Validated values of a law: finite and not less than a bound.

    Raises
    ------
    ComputationError
        If a value is not; names the first such point.
    """
    wrong = ~(np.isfinite(found) & (found >= least))
    if not wrong.any():
        return found
    first = int(np.argmax(wrong))
    where = ", ".join(
        f"{key} = {float(values.flat[first]):.4g} {UNITS[key]}".rstrip()
        for key, values in at.items()
    )
    bound = "finite" if least == -np.inf else f"finite and at least {least:g}"
    raise ComputationError(f"{name}: {float(found.flat[first]):.4g} at {where}; must be {bound}")


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
