"""Laws by a formula: an expression of the case file, a plain function of arrays, or a number."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..errors import CaseError, ComputationError
from .coefficients import Constant
from .expressions import Expression
from .interfaces import INTERFACE_VARIABLES, UNITS, WEAR_VARIABLES, Law, LocalState
from .plausible import require_wear_rate
from .power_wear import floored

_STEP = 1e-5
"""Relative step of central differences: error 1e-10 times the third derivative."""
_SCALES = {"p": 1.0, "v": 1e-6, "T": 1.0, "depth": 1e-12, "mu": 1e-3}
"""Smallest reference magnitude of each variable for the step, in SI."""
_TINY = 1e-30  # relative imaginary step
_AGREED = 1e-4  # largest relative difference for which the complex step is used


@dataclass(frozen=True)
class FormulaLaw:
    """Coefficient of friction, or conductance, by a formula.

    Attributes
    ----------
    formula : Expression or PlainFunction
        Value in the variables of `NAMES`.
    name : str
        Name of the law, for messages.
    least : float
        Smallest valid value.
    """

    NAMES: ClassVar[tuple[str, ...]] = INTERFACE_VARIABLES

    formula: Expression | PlainFunction
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


@dataclass(frozen=True)
class PlainFunction:
    """Function of arrays whose parameter names are the variables.

    The derivative is that of a complex step (Squire and Trapp, SIAM Rev. 40 (1998) 110) wherever it
    agrees with central differences, otherwise theirs: at kinks, and in functions that discard the
    imaginary part.

    Attributes
    ----------
    function : callable
    variables : frozenset of str
    """

    function: Callable[..., np.ndarray]
    variables: frozenset[str]

    @classmethod
    def of(cls, function: Callable[..., np.ndarray], known: tuple[str, ...]) -> PlainFunction:
        """Wrap a function whose parameters are some of the known variables.

        Raises
        ------
        CaseError
            If it has other parameters.
        """
        names = list(inspect.signature(function).parameters)
        wrong = [name for name in names if name not in known]
        if wrong:
            raise CaseError(
                f"law {_name(function)}: has the parameter {wrong[0]!r}; known: {', '.join(known)}"
            )
        return cls(function, frozenset(names))

    def value(self, at: Mapping[str, np.ndarray]) -> np.ndarray:
        """Value at arrays of the variables, of their common shape."""
        return np.real(self._called(at))

    def slope(self, at: Mapping[str, np.ndarray], by: str) -> np.ndarray:
        """Derivative with respect to one of the variables."""
        shape = np.broadcast_shapes(*(np.shape(values) for values in at.values()))
        if by not in self.variables:
            return np.zeros(shape)
        x = np.asarray(at[by], dtype=float)
        step = _STEP * np.maximum(np.abs(x), _SCALES[by])
        below = np.maximum(x - step, 0.0)  # no variable is negative
        ends = (self.value({**at, by: place}) for place in (x + step, below))
        difference = np.subtract(*ends) / (x + step - below)
        by_complex_step = self._complex_step(at, by, x)
        if by_complex_step is None:
            return difference
        agrees = np.abs(by_complex_step - difference) <= _AGREED * np.abs(difference)
        return np.where(agrees, by_complex_step, difference)

    def _complex_step(self, at: Mapping[str, np.ndarray], by: str, x: np.ndarray):
        """Derivative by a complex step; None if the function fails for complex numbers."""
        step = _TINY * np.maximum(np.abs(x), _SCALES[by])
        try:
            with np.errstate(all="ignore"):
                found = self.function(**self._own({**at, by: x + 1j * step}))
        except Exception:  # any exception of a function without support for complex numbers
            return None
        return np.imag(found) / step

    def _own(self, at: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        return {name: values for name, values in at.items() if name in self.variables}

    def _called(self, at: Mapping[str, np.ndarray]) -> np.ndarray:
        shape = np.broadcast_shapes(*(np.shape(values) for values in at.values()))
        try:
            with np.errstate(all="ignore"):  # the caller checks for finite values
                found = np.asarray(self.function(**self._own(at)))
            if not np.issubdtype(found.dtype, np.number):
                raise TypeError(f"returned {found.dtype}, not numbers")
        except (TypeError, ValueError) as error:
            raise CaseError(
                f"law {_name(self.function)}: must take and return arrays: {error}"
            ) from error
        if found.shape not in ((), shape):
            raise CaseError(
                f"law {_name(self.function)}: returned the shape {found.shape} for variables of "
                f"the shape {shape}"
            )
        return np.zeros(shape) + found


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


def _name(function: Callable) -> str:
    return getattr(function, "__name__", repr(function))
