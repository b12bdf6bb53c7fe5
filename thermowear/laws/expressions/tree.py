"""Expressions as trees, evaluated with their derivative (forward-mode differentiation).

A node is a constant in SI, the name of a variable, or a tuple of an operation and its operands:
``"+"`` and ``"*"`` have any number of them, ``"-"`` (negative) and ``"/"`` (reciprocal) one,
``"^"`` two; the others are `FUNCTIONS` and `EXTREMES`. Derivatives are taken with respect to one
variable; at kinks (``abs``, ``min``, ``max``) they are one-sided.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial, reduce
from typing import Any

import numpy as np

Node = float | str | tuple[Any, ...]
Pair = tuple[np.ndarray, np.ndarray]
"""Value and derivative, both of the shape of the variables or scalars."""
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


def evaluate(node: Node, values: Mapping[str, np.ndarray], by: str) -> Pair:
    """Value of a tree, and derivative with respect to the variable `by`."""
    if isinstance(node, float):
        return np.asarray(node), np.asarray(0.0)
    if isinstance(node, str):
        return values[node], np.asarray(float(node == by))
    operation, *operands = node
    return _OPERATIONS[operation](*(evaluate(operand, values, by) for operand in operands))


def variables(node: Node) -> frozenset[str]:
    """Variables in a tree."""
    if isinstance(node, tuple):
        return frozenset().union(*(variables(operand) for operand in node[1:]))
    return frozenset({node} if isinstance(node, str) else ())


def _chain(outer: np.ndarray, inner: np.ndarray) -> np.ndarray:
    """Product ``outer * inner``, 0 also if the inner derivative is 0 and the outer one infinite."""
    return np.where(inner == 0.0, 0.0, outer * np.where(inner == 0.0, 1.0, inner))


def _multiply(a: Pair, b: Pair) -> Pair:
    return a[0] * b[0], _chain(b[0], a[1]) + _chain(a[0], b[1])


def _power(base: Pair, exponent: Pair) -> Pair:
    value = np.power(base[0], exponent[0])
    slope = _chain(exponent[0] * np.power(base[0], exponent[0] - 1.0), base[1])
    logarithm = np.log(np.where(value == 0.0, 1.0, base[0]))
    return value, slope + _chain(value * logarithm, exponent[1])


def _call(function: Function, argument: Pair) -> Pair:
    return function.value(argument[0]), _chain(function.slope(argument[0]), argument[1])


def _extreme(keeps: Callable[..., np.ndarray], a: Pair, b: Pair) -> Pair:
    kept = keeps(a[0], b[0])
    return np.where(kept, a[0], b[0]), np.where(kept, a[1], b[1])


def _repeated(operation: Callable[[Pair, Pair], Pair]) -> Callable[..., Pair]:
    return lambda *operands: reduce(operation, operands)


_OPERATIONS: dict[str, Callable[..., Pair]] = {
    "+": _repeated(lambda a, b: (a[0] + b[0], a[1] + b[1])),
    "*": _repeated(_multiply),
    "-": lambda a: (-a[0], -a[1]),
    "/": partial(_call, Function(lambda x: 1 / x, lambda x: -1 / x**2)),
    "^": _power,
    **{name: partial(_call, function) for name, function in FUNCTIONS.items()},
    **{name: _repeated(partial(_extreme, keeps)) for name, keeps in EXTREMES.items()},
}


@dataclass(frozen=True)
class Expression:
    """Arithmetic expression in physical variables.

    Attributes
    ----------
    text : str
        Text as written.
    node : Node
    variables : frozenset of str
        Variables that occur in it.
    """

    text: str
    node: Node
    variables: frozenset[str]

    @property
    def constant(self) -> float | None:
        """Value of an expression without variables."""
        return self.node if isinstance(self.node, float) else None

    def value(self, at: Mapping[str, np.ndarray]) -> np.ndarray:
        """Value in SI at arrays of the variables, of their common shape."""
        return self._both(at, "")[0]

    def slope(self, at: Mapping[str, np.ndarray], by: str) -> np.ndarray:
        """Derivative with respect to a variable, in SI."""
        return self._both(at, by)[1]

    def _both(self, at: Mapping[str, np.ndarray], by: str) -> tuple[np.ndarray, np.ndarray]:
        shape = np.broadcast_shapes(*(np.shape(values) for values in at.values()))
        arrays = {name: np.asarray(values, dtype=float) for name, values in at.items()}
        with np.errstate(all="ignore"):  # the caller checks for finite values
            value, slope = evaluate(self.node, arrays, by)
        return np.zeros(shape) + value, np.zeros(shape) + slope
