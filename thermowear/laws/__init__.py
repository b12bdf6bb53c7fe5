"""Pure functions of arrays: wear laws and the principle of steady wear."""

from .functionals import (
    PowerFunctional,
    friction_dissipation,
    wear_dissipation,
    wear_volume_rate,
)
from .interface import ContactPatch, contact_patch
from .locking import NotCarried, SelfLocking
from .minimum import Minimum, least_wear_dissipation, minimise
from .motions import RigidMotion, rotation, translation
from .perturbation import admissible_changes
from .rates import WearVectors, wear_vectors
from .spreading import InPlace, Rings, Share, Spreading, Track, rings
from .steady import SteadyWear, steady_pressure
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
