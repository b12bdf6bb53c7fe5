"""Pure functions of arrays: laws of the interface and the principle of steady wear."""

from __future__ import annotations

import importlib
from typing import Any

from .distribution import Distribution, InPlace, rings, round_duty, uniform_track
from .formulas import interface_law, wear_rate
from .interfaces import Law, LocalState, parameter, registered, registered_laws
from .motions import RigidMotion, rotation, translation
from .wear import PowerWear

_PRINCIPLE = {
    "minimum": (
        "Minimum",
        "PowerFunctional",
        "admissible_changes",
        "friction_dissipation",
        "least_wear_dissipation",
        "minimise",
        "wear_dissipation",
        "wear_volume_rate",
    ),
    "patch": ("ContactPatch", "WearVectors", "contact_patch", "wear_vectors"),
    "steady": ("NotCarried", "SelfLocking", "SteadyWear", "steady_pressure"),
}
"""Names imported lazily: reading a case needs no optimisation library."""


def __getattr__(name: str) -> Any:
    for module, names in _PRINCIPLE.items():
        if name in names:
            return getattr(importlib.import_module(f".principle.{module}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
