"""Expression trees, evaluated with their derivative (forward-mode differentiation).

A node is a constant in SI, the name of a variable, or a tuple of an operation and its operands:
``"+"`` and ``"*"`` have any number of them, ``"-"`` (negative) and ``"/"`` (reciprocal) one,
``"^"`` two; the others are in `functions`. Derivatives are taken with respect to one variable;
at kinks (``abs``, ``min``, ``max``) they are one-sided.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial, reduce
from typing import Any

import numpy as np

from .functions import EXTREMES, FUNCTIONS, Function

Node = float | str | tuple[Any, ...]
Pair = tuple[np.ndarray, np.ndarray]
"""Value and derivative, both of the shape of the variables or scalars."""


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


def _add(a: Pair, b: Pair) -> Pair:
    return a[0] + b[0], a[1] + b[1]


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
    "+": _repeated(_add),
    "*": _repeated(_multiply),
    "-": lambda a: (-a[0], -a[1]),
    "/": partial(_call, Function(lambda x: 1 / x, lambda x: -1 / x**2)),
    "^": _power,
    **{name: partial(_call, function) for name, function in FUNCTIONS.items()},
    **{name: _repeated(partial(_extreme, keeps)) for name, keeps in EXTREMES.items()},
}
