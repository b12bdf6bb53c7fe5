"""Interfaces of laws: wear rate of a body, and coefficients of the interface.

Every law is a function of arrays at contact points, in SI, with its derivative with respect to the
pressure. Variables have the names of expressions: ``p`` pressure, ``v`` sliding speed, ``T``
temperature, ``depth`` worn depth, ``mu`` coefficient of friction.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

Values = np.ndarray | float
WEAR_VARIABLES = ("p", "v", "T", "depth", "mu")
INTERFACE_VARIABLES = ("p", "v", "T")


class WearRate(Protocol):
    """Wear rate of one body.

    Attributes
    ----------
    variables : frozenset of str
        Variables of the rate, a subset of `WEAR_VARIABLES`.
    """

    @property
    def variables(self) -> frozenset[str]: ...

    def rate(
        self,
        pressure: np.ndarray,
        speed: Values,
        temperature: Values = 0.0,
        depth: Values = 0.0,
        friction: Values = 0.0,
    ) -> np.ndarray:
        """Depth worn per time at points (n,) [m/s]; 0 at negative pressures.

        Parameters
        ----------
        pressure : ndarray, shape (n,)
            Pressure [Pa].
        speed : ndarray, shape (n,)
            Sliding speed [m/s].
        temperature : ndarray, shape (n,)
            Surface temperature of the body [K].
        depth : ndarray, shape (n,)
            Worn depth of the body so far [m].
        friction : ndarray, shape (n,)
            Coefficient of friction.
        """
        ...

    def slope(
        self,
        pressure: np.ndarray,
        speed: Values,
        temperature: Values = 0.0,
        depth: Values = 0.0,
        friction: Values = 0.0,
    ) -> np.ndarray:
        """Derivative of the rate with respect to the pressure [m/(s Pa)], finite at 0 pressure."""
        ...


class InterfaceLaw(Protocol):
    """Coefficient of friction [-], or contact conductance [W/(m² K)].

    Attributes
    ----------
    variables : frozenset of str
        Variables of the coefficient, a subset of `INTERFACE_VARIABLES`.
    """

    @property
    def variables(self) -> frozenset[str]: ...

    def value(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Coefficient at points (n,).

        Parameters
        ----------
        pressure : ndarray, shape (n,)
            Pressure [Pa].
        speed : ndarray, shape (n,)
            Sliding speed [m/s].
        temperature : ndarray, shape (n,)
            Mean temperature of both faces [K].
        """
        ...

    def slope(self, pressure: np.ndarray, speed: Values, temperature: Values) -> np.ndarray:
        """Derivative with respect to the pressure [1/Pa times the unit of the value]."""
        ...


class Formula(Protocol):
    """Function of named variables with its derivatives: an expression, or a plain function."""

    @property
    def variables(self) -> frozenset[str]: ...

    def value(self, at: Mapping[str, np.ndarray]) -> np.ndarray:
        """Value at arrays of the variables, of their common shape."""
        ...

    def slope(self, at: Mapping[str, np.ndarray], by: str) -> np.ndarray:
        """Derivative with respect to one of the variables."""
        ...
