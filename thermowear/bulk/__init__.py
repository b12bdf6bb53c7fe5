"""What happens inside the bodies: elasticity with thermal strain, heat conduction."""

from .bodies import Bodies, distribute
from .conduction import Conduction, conduction
from .elasticity import Elasticity, ElasticMaterial, elasticity
from .kinematics import Axisymmetric, PlaneStrain, PlaneStress

__all__ = [
    "Axisymmetric",
    "Bodies",
    "Conduction",
    "ElasticMaterial",
    "Elasticity",
    "PlaneStrain",
    "PlaneStress",
    "conduction",
    "distribute",
    "elasticity",
]
