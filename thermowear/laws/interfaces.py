"""Interface of laws: wear rate of a body, coefficient of friction, contact conductance.

Every law is a function of the contact state, in SI, with its derivative with respect to the
pressure. Variables have the names of expressions: ``p``, ``v``, ``T``, ``depth``, ``mu``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, Protocol

import numpy as np

Values = np.ndarray | float
UNITS = {"p": "Pa", "v": "m/s", "T": "K", "depth": "m", "mu": ""}
"""SI units of the variables of laws."""
WEAR_VARIABLES = tuple(UNITS)
INTERFACE_VARIABLES = ("p", "v", "T")


class LocalState(NamedTuple):
    """State at the contact points: arrays of shape (n,), or numbers equal at all points.

    Attributes
    ----------
    p : ndarray
        Pressure [Pa].
    v : ndarray
        Sliding speed [m/s].
    T : ndarray
        Surface temperature of the body for its wear rate, otherwise mean of both faces [K].
    depth : ndarray
        Worn depth of the body so far [m].
    mu : ndarray
        Coefficient of friction.
    """

    p: Values
    v: Values
    T: Values = 0.0
    depth: Values = 0.0
    mu: Values = 0.0

    def arrays(self, names: tuple[str, ...]) -> dict[str, np.ndarray]:
        """Variables by name, broadcast to a common shape."""
        given = (np.asarray(getattr(self, name), dtype=float) for name in names)
        return dict(zip(names, np.broadcast_arrays(*given), strict=True))


class Law(Protocol):
    """Wear rate of one body [m/s], coefficient of friction [-] or conductance [W/(m² K)].

    Attributes
    ----------
    variables : frozenset of str
        Variables that it depends on: a subset of `WEAR_VARIABLES` for a wear rate, otherwise of
        `INTERFACE_VARIABLES`.
    """

    @property
    def variables(self) -> frozenset[str]: ...

    def value(self, at: LocalState) -> np.ndarray:
        """Value at points (n,); the wear rate at negative pressures is 0."""
        ...

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure, finite at zero pressure."""
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
