"""Expressions in physical variables, with their values and derivatives in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .dimensions import Dimension
from .parser import Parser, Units
from .tokens import fault
from .tree import Node, evaluate, variables


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


def parse_expression(
    text: str, known: Mapping[str, Dimension], unit: str, units: Units
) -> Expression:
    """Parse an expression and check the units in it.

    Parameters
    ----------
    text : str
    known : mapping of str to Dimension
        Variables that may occur.
    unit : str
        Unit of the value; empty for a dimensionless number.
    units : callable
        Map from the text of a unit to its SI factor and dimension.

    Raises
    ------
    ValueError
        One-line message with the position of the fault in the text.
    """
    found = Parser(text, known, units).parse()
    dimension = units(unit)[1] if unit else Dimension()
    if not found.dimension.same(dimension):
        needed = unit or "a dimensionless number"
        raise fault(found.start, f"the value has the unit {found.dimension}; needs {needed}")
    return Expression(text, found.node, variables(found.node))
