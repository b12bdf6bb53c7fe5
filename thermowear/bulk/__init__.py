"""Finite element models of the bodies: elasticity with thermal strain, heat conduction."""

from .bodies import Bodies, distribute
from .elasticity.elasticity import Elasticity, ElasticMaterial, elasticity
from .heat.conduction import Conduction
from .heat.heat_equation import conduction
from .kinematics import Axisymmetric, PlaneStrain, PlaneStress
