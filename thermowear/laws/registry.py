"""Registry of laws that case files select by name: ``rate = { type = "energy", … }``.

A law is a frozen dataclass in a module of `named`, registered by a decorator. Its fields are the
keys of its table; `parameter` defines the unit and the bounds of each.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import field
from typing import Any, Literal, TypeVar

Role = Literal["wear", "friction", "conductance"]
Registered = TypeVar("Registered", bound=type)

REGISTERED: dict[str, dict[str, type]] = {"wear": {}, "friction": {}, "conductance": {}}
"""Laws by role and name; `registered_laws` imports the modules of `named` first."""


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
