"""Model: bodies, interfaces, holders, motion and heat, without any case file."""

from .analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
    StaticAnalysis,
    TransientAnalysis,
)
from .body import Body, Material
from .conditions import Heat, Holder, Motion
from .face_wear import CompositeWear, FaceWear
from .interface import ContactMethod, HardnessConductance, Interface
from .model import Discretisation, MeshSource, Model
from .tracks import CircularTrack, EvenTrack, PinTrack, TabulatedTrack, Track
