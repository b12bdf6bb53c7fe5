"""Laws defined by a formula: an expression of the case file, or a plain function of arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import ComputationError
from .interfaces import INTERFACE_VARIABLES, WEAR_VARIABLES, Formula, Values
from .power_wear import floored

_UNITS = {"p": "Pa", "v": "m/s", "T": "K", "depth": "m", "mu": ""}


@dataclass(frozen=True)
class FormulaWear:
    """Wear rate by a formula.

    Attributes
    ----------
    formula : Formula
        Rate in variables of `WEAR_VARIABLES` [m/s].
    name : str
        Name of the law, for messages.
    """

    formula: Formula
    name: str = "wear rate"

    @property
    def variables(self) -> frozenset[str]:
        """Variables of the formula."""
        return self.formula.variables

    def rate(
        self,
        pressure: np.ndarray,
        speed: Values,
        temperature: Values = 0.0,
        depth: Values = 0.0,
        friction: Values = 0.0,
    ) -> np.ndarray:
        """Depth worn per time at points (n,) [m/s]."""
        pressing = np.maximum(pressure, 0.0)
        at = _arrays(WEAR_VARIABLES, pressing, speed, temperature, depth, friction)
        return required(self.name, self.formula.value(at), at, least=0.0)

    def slope(
        self,
        pressure: np.ndarray,
        speed: Values,
        temperature: Values = 0.0,
        depth: Values = 0.0,
        friction: Values = 0.0,
    ) -> np.ndarray:
        """Derivative of the rate with respect to the pressure [m/(s Pa)]."""
        at = _arrays(WEAR_VARIABLES, floored(pressure), speed, temperature, depth, friction)
        return required(f"derivative of the {self.name}", self.formula.slope(at, "p"), at)


@dataclass(frozen=True)
class FormulaLaw:
    """Coefficient of friction, or conductance, by a formula.

    Attributes
    ----------
    formula : Formula
        Coefficient in variables of `INTERFACE_VARIABLES`.
    name : str
        Name of the law, for messages.
    least : float
        Smallest valid value.
    """

    formula: Formula
    name: str = "coefficient"
    least: float = -np.inf

    @property
    def variables(self) -> frozenset[str]:
        """Variables of the formula."""
        return self.formula.variables

    def value(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Coefficient at points (n,)."""
        at = _arrays(INTERFACE_VARIABLES, pressure, speed, temperature)
        return required(self.name, self.formula.value(at), at, self.least)

    def slope(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Derivative with respect to the pressure."""
        at = _arrays(INTERFACE_VARIABLES, floored(pressure), speed, temperature)
        return required(f"derivative of the {self.name}", self.formula.slope(at, "p"), at)


def _arrays(names: tuple[str, ...], *values: Values) -> dict[str, np.ndarray]:
    """Variables by name, broadcast to a common shape."""
    arrays = np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in values))
    return dict(zip(names, arrays, strict=True))


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
        f"{key} = {float(values.flat[first]):.4g} {_UNITS[key]}".rstrip()
        for key, values in at.items()
    )
    bound = "finite" if least == -np.inf else f"finite and at least {least:g}"
    raise ComputationError(f"{name}: {float(found.flat[first]):.4g} at {where}; must be {bound}")
