"""Laws that are registered, by their names."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping

from . import named
from .registry import REGISTERED, Role


def registered_laws(role: Role) -> Mapping[str, type]:
    """Laws of a role by their names: those of the folder `named`, and those of the user."""
    for module in pkgutil.iter_modules(named.__path__):
        importlib.import_module(f"{named.__name__}.{module.name}")
    return REGISTERED[role]
