"""Models written in Python: bodies on a user's dolfinx meshes with their own tags."""

from .body import BodySurface, MeshBody
from .conversion import (
    Heat,
    LayeredWear,
    LoadHistory,
    Material,
    PowerWear,
    PressureConductance,
    TimeHistory,
)
from .face_pair import FacePair
from .face_tie import FaceTie
from .holding import Rotation, SurfaceHolder, Translation
from .march import MarchState
from .scripted_model import ScriptedModel
from .solution import ModelSolution, PointValues

Body, Interface, Holder, Model = MeshBody, FacePair, SurfaceHolder, ScriptedModel
Tie = FaceTie
