"""Model of a case."""

from __future__ import annotations

from ...case.tables.schema import Case
from ...model.discretisation import Discretisation
from ...model.model import Model
from .bodies import bodies
from .driving import holder, motion
from .heat import heat
from .interface import interface
from .meshes import CaseMeshes


def model_of(case: Case) -> Model:
    """Model of a validated case."""
    geometry = case.geometry
    return Model(
        kinematics=case.model,
        bodies=bodies(case),
        interfaces=(interface(case),),
        holders=(holder(case),),
        meshes=CaseMeshes(case.model, geometry, case.mesh, case),
        discretisation=Discretisation(case.mesh.degree, case.contact.positioning),
        motion=motion(case),
        heat=heat(case),
        thickness=geometry.thickness_factor,
        sector=geometry.sector,
        symmetry=geometry.symmetry,
        title=case.title,
    )
