"""Model: bodies, interfaces, holders, motion and heat, without any case file."""

from .analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
    StaticAnalysis,
    TransientAnalysis,
)
from .body import Body
from .heat import Heat
from .holder import Holder
from .interface import ContactMethod, HardnessConductance, Interface
from .material import Material
from .meshes import MeshSource
from .model import Discretisation, Model
from .motion import Motion
from .wear import CircularTrack, EvenTrack, FaceWear

__all__ = [
    "Analysis",
    "Body",
    "CircularTrack",
    "ContactMethod",
    "Discretisation",
    "EvenTrack",
    "FaceWear",
    "FrettingAnalysis",
    "HardnessConductance",
    "Heat",
    "Holder",
    "Interface",
    "Material",
    "MeshSource",
    "Model",
    "Motion",
    "ReciprocatingAnalysis",
    "StaticAnalysis",
    "TransientAnalysis",
]
