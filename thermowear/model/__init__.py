"""Model: bodies, interfaces, holders, motion and heat, without any case file."""

from .analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
    StaticAnalysis,
    TransientAnalysis,
)
from .body import Body, Material
from .heat import Heat
from .holder import Holder, Motion
from .interface import ContactMethod, HardnessConductance, Interface
from .meshes import MeshSource
from .model import Discretisation, Model
from .wear import CircularTrack, EvenTrack, FaceWear
