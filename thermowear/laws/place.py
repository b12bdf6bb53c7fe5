"""Given fields on faces: functions of place, by an expression or a plain function of arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .expressions import Expression
from .formulas import PlainFunction

PLACE = {"x": "m", "y": "m", "z": "m", "r": "m"}
"""Coordinates with their units; r is the distance from the axis of rotation, along y or z."""
_ROUNDING = 1e-9
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
        wrong = ~(found >= -_ROUNDING * np.nanmax(np.abs(found), initial=0.0))
        wrong |= ~np.isfinite(found)
        if wrong.any():
            first = int(np.argmax(wrong))
            where = ", ".join(f"{key} = {values[first]:.6g} m" for key, values in places.items())
            raise ValueError(f"{found[first]:.4g} at {where}; must be finite and at least 0")
        return np.maximum(found, 0.0)
