"""Pure functions of arrays: laws of the interface and the principle of steady wear."""

from __future__ import annotations

import importlib
from typing import Any

from .by_name import registered_laws
from .distribution import Distribution, DutyFactor, InPlace, Rings, UniformTrack, rings
from .from_python import interface_law, wear_rate
from .interfaces import Law, LocalState
from .motions import RigidMotion, rotation, translation
from .power_wear import PowerWear
from .registry import parameter, registered

_PRINCIPLE = {
    "functionals": (
        "PowerFunctional",
        "friction_dissipation",
        "wear_dissipation",
        "wear_volume_rate",
    ),
    "minimum": ("Minimum", "least_wear_dissipation", "minimise"),
    "patch": ("ContactPatch", "contact_patch"),
    "perturbation": ("admissible_changes",),
    "solvability": ("NotCarried", "SelfLocking"),
    "steady": ("SteadyWear", "steady_pressure"),
    "wear_vectors": ("WearVectors", "wear_vectors"),
}
"""Names imported lazily: reading a case needs no optimisation library."""

__all__ = [  # noqa: PLE0604
    "Distribution",
    "DutyFactor",
    "InPlace",
    "Law",
    "LocalState",
    "PowerWear",
    "RigidMotion",
    "Rings",
    "UniformTrack",
    "interface_law",
    "parameter",
    "registered",
    "registered_laws",
    "rings",
    "rotation",
    "translation",
    "wear_rate",
    *(name for names in _PRINCIPLE.values() for name in names),
]


def __getattr__(name: str) -> Any:
    for module, names in _PRINCIPLE.items():
        if name in names:
            return getattr(importlib.import_module(f".principle.{module}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
