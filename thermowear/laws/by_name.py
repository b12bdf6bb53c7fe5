"""Look-up of registered laws by name."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping

from . import named
from .registry import REGISTERED, Role


def registered_laws(role: Role) -> Mapping[str, type]:
    """Laws of a role by name: modules of the folder `named`, and laws of the user."""
    for module in pkgutil.iter_modules(named.__path__):
        importlib.import_module(f"{named.__name__}.{module.name}")
    return REGISTERED[role]
