"""Interface of laws (wear rate, coefficient of friction, conductance), and their registry.

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
from dataclasses import field
from typing import Any, Literal, NamedTuple, Protocol, TypeVar

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
