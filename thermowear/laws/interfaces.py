"""Interface of laws (wear rate, friction, conductance), and coefficients that follow tables.

Every law is a function of the contact state, in SI, with its derivative with respect to the
pressure. Variables have the names of expressions: ``p``, ``v``, ``T``, ``depth``, ``mu``.

Case files select registered laws by name: ``rate = { type = "energy", … }``. Such a law is a frozen
dataclass in a module of `named`, registered by a decorator. Its fields are the keys of its table;
`parameter` defines the unit and the bounds of each.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal, NamedTuple, Protocol, TypeVar

import numpy as np

Values = np.ndarray | float
UNITS = {"p": "Pa", "v": "m/s", "T": "K", "depth": "m", "mu": ""}
"""SI units of the variables of laws."""
WEAR_VARIABLES = tuple(UNITS)
INTERFACE_VARIABLES = ("p", "v", "T")
Role = Literal["wear", "friction", "conductance"]
Registered = TypeVar("Registered", bound=type)

REGISTERED: dict[str, dict[str, type]] = {"wear": {}, "friction": {}, "conductance": {}}
"""Laws by role and name; `registered_laws` imports the modules of `named` first."""


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


def parameter(unit: str, example: str, *, default: Any = None, **bounds: float) -> Any:
    """Field of a registered law.

    Parameters
    ----------
    unit : str
        SI unit; empty for a plain number.
    example : str
        A well-formed value, for messages.
    default : float, optional
        Default in SI; without one the key is required.
    **bounds
        Bounds ``gt``, ``ge``, ``le``, ``ne`` in SI.
    """
    metadata = {"unit": unit, "example": example, "bounds": bounds}
    if default is None:
        return field(metadata=metadata)
    return field(default=default, metadata=metadata)


def registered(role: Role, name: str) -> Callable[[Registered], Registered]:
    """Decorator that registers a law under a name for case files."""

    def register(law: Registered) -> Registered:
        REGISTERED[role][name] = law
        return law

    return register


def registered_laws(role: Role) -> Mapping[str, type]:
    """Laws of a role by name: modules of the folder `named`, and laws of the user."""
    named = importlib.import_module(f"{__package__}.named")
    for module in pkgutil.iter_modules(named.__path__):
        importlib.import_module(f"{named.__name__}.{module.name}")
    return REGISTERED[role]


@dataclass(frozen=True)
class Constant:
    """Constant coefficient of friction [-], or conductance [W/(m² K)]."""

    number: float
    variables: ClassVar[frozenset[str]] = frozenset()

    def value(self, at: LocalState) -> np.ndarray:
        """Coefficient at points (n,)."""
        return np.full(np.shape(at.p), self.number)

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure: 0."""
        return np.zeros(np.shape(at.p))


@dataclass(frozen=True)
class Table1D:
    """Piecewise linear function of one variable, constant beyond its ends.

    Attributes
    ----------
    at : tuple of float
        Increasing abscissae, in SI.
    values : tuple of float
        Values at the abscissae.
    """

    at: tuple[float, ...]
    values: tuple[float, ...]

    def value(self, x: np.ndarray | float) -> np.ndarray:
        """Values at an array of any shape."""
        return np.asarray(np.interp(x, self.at, self.values))

    def slope(self, x: np.ndarray | float) -> np.ndarray:
        """Derivative; at corners, that of the next segment."""
        slopes = np.concatenate([[0.0], np.diff(self.values) / np.diff(self.at), [0.0]])
        return slopes[np.searchsorted(self.at, x, side="right")]

    def integral(self, start: float, x: np.ndarray) -> np.ndarray:
        """Integral from `start` to `x`."""
        return self._integral(np.asarray(x, dtype=float)) - self._integral(np.asarray(start))

    def _integral(self, x: np.ndarray) -> np.ndarray:
        """Exact integral from the first abscissa, by the trapezoidal rule."""
        at, values = np.array(self.at), np.array(self.values)
        whole = np.concatenate([[0.0], np.cumsum(np.diff(at) * (values[1:] + values[:-1]) / 2)])
        last = np.maximum(np.searchsorted(at, x, side="right") - 1, 0)
        return whole[last] + (x - at[last]) * (values[last] + self.value(x)) / 2


@dataclass(frozen=True)
class Multipliers:
    """Law that is a product of tabulated factors.

    Attributes
    ----------
    tables : mapping of str to Table1D
        Table of each factor by its variable T, p or v.
    """

    tables: Mapping[str, Table1D] = field(default_factory=dict)

    @property
    def variables(self) -> frozenset[str]:
        """Variables with a table, named as in `Law`."""
        return frozenset(self.tables)

    def value(self, at: LocalState) -> np.ndarray:
        """Product of the factors at points (n,)."""
        product = np.ones(np.broadcast_shapes(np.shape(at.p), np.shape(at.v)))
        for name, table in self.tables.items():
            product = product * table.value(getattr(at, name))
        return product

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative of the product with respect to the pressure [1/Pa]."""
        others = {name: table for name, table in self.tables.items() if name != "p"}
        slope = self.tables["p"].slope(at.p) if "p" in self.tables else 0.0
        return Multipliers(others).value(at) * slope


@dataclass(frozen=True)
class Multiplied:
    """Coefficient of the interface times tabulated factors."""

    law: Law
    factors: Multipliers

    @property
    def variables(self) -> frozenset[str]:
        """Variables of the law and of the factors."""
        return self.law.variables | self.factors.variables

    def value(self, at: LocalState) -> np.ndarray:
        """Coefficient at points (n,)."""
        return self.law.value(at) * self.factors.value(at)

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure."""
        first = self.law.slope(at) * self.factors.value(at)
        return first + self.law.value(at) * self.factors.slope(at)


def harmonic_mean(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Harmonic mean ``2 a b / (a + b)``, for two resistances in series."""
    return 2 * a * b / (a + b)


@dataclass(frozen=True)
class PressureConductance:
    """Conductance proportional to the pressure: ``h = coefficient k p / H``.

    k and H are the harmonic means ``2 k1 k2 / (k1 + k2)`` of both bodies' conductivities and
    hardnesses. The model of MOOSE (``GapFluxModelPressureDependentConduction``) and of 4C.

    Attributes
    ----------
    coefficient : float
        Coefficient [1/m].
    conductivity : ndarray, shape (n,)
        Mean conductivity k at the points [W/(m K)].
    hardness : ndarray, shape (n,)
        Mean hardness H at the points [Pa].
    """

    coefficient: float
    conductivity: np.ndarray
    hardness: np.ndarray
    variables: ClassVar[frozenset[str]] = frozenset("p")

    def value(self, at: LocalState) -> np.ndarray:
        """Conductance at points (n,) [W/(m² K)]."""
        return self.coefficient * self.conductivity * np.asarray(at.p) / self.hardness

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure [W/(m² K Pa)]."""
        slope = self.coefficient * self.conductivity / self.hardness
        return np.broadcast_to(slope, np.shape(at.p))
