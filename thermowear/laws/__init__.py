"""Pure functions of arrays: wear laws and the principle of steady wear."""

from .distribution import InPlace, Rings, Share, Spreading, Track, rings
from .motions import RigidMotion, rotation, translation
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
from .wear import WearLaw

__all__ = [
    "ContactPatch",
    "InPlace",
    "Minimum",
    "NotCarried",
    "PowerFunctional",
    "RigidMotion",
    "Rings",
    "SelfLocking",
    "Share",
    "Spreading",
    "SteadyWear",
    "Track",
    "WearLaw",
    "WearVectors",
    "admissible_changes",
    "contact_patch",
    "friction_dissipation",
    "least_wear_dissipation",
    "minimise",
    "rings",
    "rotation",
    "steady_pressure",
    "translation",
    "wear_dissipation",
    "wear_vectors",
    "wear_volume_rate",
]
