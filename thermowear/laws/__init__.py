"""Pure functions of arrays: laws of the interface and the principle of steady wear."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from .by_name import registered_laws
from .distribution import Distribution, DutyFactor, InPlace, Rings, UniformTrack, rings
from .from_python import interface_law, wear_rate
from .interfaces import Law, LocalState
from .motions import RigidMotion, rotation, translation
from .power_wear import PowerWear
from .registry import parameter, registered

if TYPE_CHECKING:
    from .principle.functionals import (
        PowerFunctional,
        friction_dissipation,
        wear_dissipation,
        wear_volume_rate,
    )
    from .principle.minimum import Minimum, least_wear_dissipation, minimise
    from .principle.patch import ContactPatch, contact_patch
    from .principle.perturbation import admissible_changes
    from .principle.solvability import NotCarried, SelfLocking
    from .principle.steady import SteadyWear, steady_pressure
    from .principle.wear_vectors import WearVectors, wear_vectors

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

__all__ = [
    "ContactPatch",
    "Distribution",
    "DutyFactor",
    "InPlace",
    "Law",
    "LocalState",
    "Minimum",
    "NotCarried",
    "PowerFunctional",
    "PowerWear",
    "RigidMotion",
    "Rings",
    "SelfLocking",
    "SteadyWear",
    "UniformTrack",
    "WearVectors",
    "admissible_changes",
    "contact_patch",
    "friction_dissipation",
    "interface_law",
    "least_wear_dissipation",
    "minimise",
    "parameter",
    "registered",
    "registered_laws",
    "rings",
    "rotation",
    "steady_pressure",
    "translation",
    "wear_dissipation",
    "wear_rate",
    "wear_vectors",
    "wear_volume_rate",
]


def __getattr__(name: str) -> Any:
    for module, names in _PRINCIPLE.items():
        if name in names:
            return getattr(importlib.import_module(f".principle.{module}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
