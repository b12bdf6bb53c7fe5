"""Models written in Python: bodies on a user's dolfinx meshes with their own tags."""

from .body import MeshBody, Surface
from .conversion import LoadHistory, TimeHistory
from .march import MarchState
from .motion import Rotation, Translation
from .physics import Heat, Material, PowerWear, PressureConductance
from .scripted_model import FacePair, ScriptedModel, SurfaceHolder
from .solution import PointValues, Solution

Body, Interface, Holder, Model = MeshBody, FacePair, SurfaceHolder, ScriptedModel

__all__ = [
    "Body",
    "Heat",
    "Holder",
    "Interface",
    "LoadHistory",
    "MarchState",
    "Material",
    "Model",
    "PointValues",
    "PowerWear",
    "PressureConductance",
    "Rotation",
    "Solution",
    "Surface",
    "TimeHistory",
    "Translation",
]
