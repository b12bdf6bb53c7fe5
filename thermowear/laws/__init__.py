"""Pure functions of arrays: laws of the interface and the principle of steady wear."""

from __future__ import annotations

import importlib
from typing import Any

from .distribution import Distribution, InPlace, rings, round_duty, uniform_track
from .formulas import interface_law, wear_rate
from .interfaces import Law, LocalState, parameter, registered, registered_laws
from .motions import RigidMotion, rotation, translation
from .power_wear import PowerWear

_PRINCIPLE = {
    "functionals": (
        "PowerFunctional",
        "admissible_changes",
        "friction_dissipation",
        "wear_dissipation",
        "wear_volume_rate",
    ),
    "minimum": ("Minimum", "least_wear_dissipation", "minimise"),
    "patch": ("ContactPatch", "WearVectors", "contact_patch", "wear_vectors"),
    "steady": ("NotCarried", "SelfLocking", "SteadyWear", "steady_pressure"),
}
"""Names imported lazily: reading a case needs no optimisation library."""


def __getattr__(name: str) -> Any:
    for module, names in _PRINCIPLE.items():
        if name in names:
            return getattr(importlib.import_module(f".principle.{module}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
