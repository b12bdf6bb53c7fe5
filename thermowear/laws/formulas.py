"""Laws by a formula: an expression of the case file, or a plain function in Python."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..errors import CaseError, ComputationError
from .expressions import Expression
from .interfaces import (
    INTERFACE_VARIABLES,
    UNITS,
    WEAR_VARIABLES,
    Constant,
    Law,
    LocalState,
    Values,
)
from .wear import floored

SAMPLES: Mapping[str, np.ndarray] = {
    "p": np.concatenate([[0.0], np.geomspace(1.0, 1e10, 61)]),
    "v": np.concatenate([[0.0], np.geomspace(1e-9, 1e2, 12)]),
    "T": np.array([200.0, 250.0, 293.15, 350.0, 500.0, 750.0, 1000.0, 1500.0]),
    "depth": np.concatenate([[0.0], np.geomspace(1e-9, 1e-2, 8)]),
    "mu": np.array([0.0, 0.1, 0.3, 1.0]),
}
"""Sample values for the checks, in SI: up to 10 GPa, 100 m/s, 1500 K and 10 mm."""
TYPICAL = LocalState(p=1e7, v=0.1, T=293.15, depth=0.0, mu=0.3)
"""Reference state of a contact, in SI."""
_ROUNDING = 1e-9  # of the rate


def require_wear_rate(law: Law) -> None:
    """Reject a wear rate that is negative or infinite somewhere, or decreases with pressure.

    Raises
    ------
    ValueError
        One-line message with a state that violates the condition.
    """
    at, rates = _sampled(law, law.variables | {"p"})
    _reject_where(~np.isfinite(rates), at, "the rate is not finite")
    _reject_where(rates < 0.0, at, "the rate is negative")
    _reject_where(rates[:1] > _ROUNDING * rates[-1:], at, "there is wear without pressure")
    decreases = np.diff(rates, axis=0) < -_ROUNDING * rates[:-1]
    _reject_where(decreases, at, "the rate decreases with increasing pressure")
    if not rates.any():
        raise ValueError("the rate is 0 at all pressures")


def require_interface_law(law: Law) -> None:
    """Reject a coefficient that is not finite somewhere, or not positive in a typical state.

    Raises
    ------
    ValueError
        One-line message with a state that violates the condition.
    """
    at, values = _sampled(law, law.variables)
    _reject_where(~np.isfinite(values), at, "the value is not finite")
    typical = typical_value(law)
    if not typical > 0.0:
        one = TYPICAL.arrays(INTERFACE_VARIABLES)
        _reject_where(np.array(True), one, f"the value is {typical:.4g}, must be greater than 0,")


def typical_value(law: Law, friction: Values = TYPICAL.mu) -> float:
    """Value of a law in the state of `TYPICAL`, at a coefficient of friction."""
    state = LocalState(*(np.array([value]) for value in TYPICAL._replace(mu=friction)))
    return float(law.value(state)[0])


def _sampled(law: Law, variables: frozenset[str]) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Tensor grid of samples, the pressure along its first axis, and values of a law on it.

    The other variables are as in `TYPICAL`.
    """
    names = [name for name in SAMPLES if name in variables]
    at = dict(zip(names, np.ix_(*(SAMPLES[name] for name in names)), strict=True))
    state = LocalState(*np.broadcast_arrays(*TYPICAL._replace(**at)))
    try:
        with np.errstate(all="ignore"):
            return at, np.broadcast_to(law.value(state), np.shape(state.p))
    except ComputationError as error:  # of a law that checks its values itself
        raise ValueError(str(error)) from None


def _reject_where(wrong: np.ndarray, at: Mapping[str, np.ndarray], what: str) -> None:
    """Raise for the first point of a grid with a violated condition."""
    if not wrong.any():
        return
    first = np.array(np.unravel_index(int(np.argmax(wrong)), wrong.shape), dtype=int)
    values = {name: x[tuple(np.minimum(first, np.array(x.shape) - 1))] for name, x in at.items()}
    where = ", ".join(f"{name} = {x:.3g} {UNITS[name]}".rstrip() for name, x in values.items())
    raise ValueError(f"{what} at {where}" if where else what)


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


PLACE = {"x": "m", "y": "m", "z": "m", "r": "m"}
"""Coordinates with their units; r is the distance from the axis of rotation, along y or z."""
_NEGATIVE = 1e-9
"""Negative values of this size relative to the largest one count as 0."""


@dataclass(frozen=True)
class PlaceFunction:
    """Nonnegative function of place.

    Attributes
    ----------
    formula : Expression or PlainFunction
        Value in some of the variables of `PLACE`.
    """

    formula: Expression | PlainFunction

    @classmethod
    def of(cls, given: float | Callable[..., np.ndarray]) -> PlaceFunction:
        """Wrap a number, or a function of arrays of some of the coordinates.

        Raises
        ------
        CaseError
            If the function has other parameters.
        """
        if callable(given):
            return cls(PlainFunction.of(given, tuple(PLACE)))
        return cls(Expression(str(given), float(given), frozenset()))

    def at(self, points: np.ndarray, axisymmetric: bool) -> np.ndarray:
        """Values (n,) at points (n, gdim); those below zero by rounding only are 0.

        Raises
        ------
        ValueError
            If a value is negative or not finite, or z occurs in a section.
        """
        places = dict(zip("xyz", points.T, strict=False))
        places["r"] = places["x"] if axisymmetric else np.hypot(places["x"], places["y"])
        if not self.formula.variables <= places.keys():
            raise ValueError("z is a coordinate of 3d models only")
        found = self.formula.value(places)
        wrong = ~(found >= -_NEGATIVE * np.nanmax(np.abs(found), initial=0.0))
        wrong |= ~np.isfinite(found)
        if wrong.any():
            first = int(np.argmax(wrong))
            where = ", ".join(f"{key} = {values[first]:.6g} m" for key, values in places.items())
            raise ValueError(f"{found[first]:.4g} at {where}; must be finite and at least 0")
        return np.maximum(found, 0.0)
