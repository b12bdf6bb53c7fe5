"""Expression trees, evaluated with their derivative (forward-mode differentiation).

Values are in SI. Derivatives are taken with respect to one variable; at kinks (``abs``, ``min``,
``max``) they are one-sided.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .functions import EXTREMES, FUNCTIONS

Values = Mapping[str, np.ndarray]
Pair = tuple[np.ndarray, np.ndarray]
"""Value and derivative, both of the shape of the variables or scalars."""


class Node(Protocol):
    """Node of an expression."""

    def at(self, values: Values, by: str) -> Pair:
        """Value, and derivative with respect to the variable `by`."""
        ...


def _chain(outer: np.ndarray, inner: np.ndarray) -> np.ndarray:
    """Product ``outer * inner``, 0 also if the inner derivative is 0 and the outer one infinite."""
    return np.where(inner == 0.0, 0.0, outer * np.where(inner == 0.0, 1.0, inner))


@dataclass(frozen=True)
class ConstantNode:
    """Constant."""

    value: float

    def at(self, values: Values, by: str) -> Pair:
        return np.asarray(self.value), np.asarray(0.0)


@dataclass(frozen=True)
class Variable:
    """Variable, by name."""

    name: str

    def at(self, values: Values, by: str) -> Pair:
        return values[self.name], np.asarray(float(self.name == by))


@dataclass(frozen=True)
class Sum:
    """Signed sum.

    Attributes
    ----------
    terms : tuple of (float, Node)
        Sign (1 or -1) and term.
    """

    terms: tuple[tuple[float, Node], ...]

    def at(self, values: Values, by: str) -> Pair:
        value, slope = np.asarray(0.0), np.asarray(0.0)
        for sign, term in self.terms:
            part, part_slope = term.at(values, by)
            value, slope = value + sign * part, slope + sign * part_slope
        return value, slope


@dataclass(frozen=True)
class Product:
    """Product and quotient.

    Attributes
    ----------
    factors : tuple of (bool, Node)
        True for a divisor, and the factor.
    """

    factors: tuple[tuple[bool, Node], ...]

    def at(self, values: Values, by: str) -> Pair:
        value, slope = np.asarray(1.0), np.asarray(0.0)
        for divides, factor in self.factors:
            other, other_slope = factor.at(values, by)
            if divides:
                value = value / other
                slope = (slope - _chain(value, other_slope)) / other
            else:
                slope = _chain(other, slope) + _chain(value, other_slope)
                value = value * other
        return value, slope


@dataclass(frozen=True)
class Power:
    """Power with a constant or a variable exponent."""

    base: Node
    exponent: Node

    def at(self, values: Values, by: str) -> Pair:
        base, base_slope = self.base.at(values, by)
        exponent, exponent_slope = self.exponent.at(values, by)
        value = np.power(base, exponent)
        slope = _chain(exponent * np.power(base, exponent - 1.0), base_slope)
        if not isinstance(self.exponent, ConstantNode):
            logarithm = np.log(np.where(value == 0.0, 1.0, base))
            slope = slope + _chain(value * logarithm, exponent_slope)
        return value, slope


@dataclass(frozen=True)
class Call:
    """Function of one variable."""

    name: str
    argument: Node

    def at(self, values: Values, by: str) -> Pair:
        function = FUNCTIONS[self.name]
        inner, inner_slope = self.argument.at(values, by)
        return function.value(inner), _chain(function.slope(inner), inner_slope)


@dataclass(frozen=True)
class Extreme:
    """Smallest or largest of several arguments."""

    name: str
    arguments: tuple[Node, ...]

    def at(self, values: Values, by: str) -> Pair:
        keeps = EXTREMES[self.name]
        value, slope = self.arguments[0].at(values, by)
        for argument in self.arguments[1:]:
            other, other_slope = argument.at(values, by)
            kept = keeps(value, other)
            value, slope = np.where(kept, value, other), np.where(kept, slope, other_slope)
        return value, slope
