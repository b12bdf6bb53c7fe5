"""Finite element models of the bodies: elasticity with thermal strain, heat conduction."""

from .bodies import Bodies, distribute
from .heat.conduction import Conduction
from .heat.heat_equation import conduction
from .kinematics import Axisymmetric, PlaneStrain, PlaneStress
from .mechanics.elasticity import Elasticity, ElasticMaterial, elasticity
