"""Hot sliding blocks in space, as models without a case file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from thermowear.geometry.mesh.tagged import TaggedMesh
from thermowear.laws import PowerWear
from thermowear.laws.interfaces import Constant
from thermowear.model import (
    Body,
    Discretisation,
    FaceWear,
    Heat,
    Holder,
    Interface,
    Material,
    Model,
    Motion,
)

from ..contact.solids import MATCHING, two_solids

FORCE, SPEED, FRICTION = 3000.0, 2.0, 0.3
UPPER = Material(10e9, 0.25, expansion=3e-5, conductivity=5.0, label="upper")
LOWER = Material(110e9, 0.3, expansion=1.1e-5, conductivity=50.0, label="lower")
COOLING = {"upper_end": 500.0, "lower_end": 2000.0}


@dataclass(frozen=True)
class BlockMeshes:
    """Source of the mesh of two blocks, see `tests.contact.solids.two_solids`."""

    divisions: tuple = MATCHING
    order: int = 1
    cell_type: str = "tetrahedron"
    path: None = None

    @cached_property
    def tagged(self) -> TaggedMesh:
        return two_solids(self.divisions, self.order, cell_type=self.cell_type)

    def mesh(self, zone):
        return self.tagged

    def expected_zone(self, force, approach, modulus):
        return None


def hot_blocks(
    meshes, solver="auto", conductance=2e4, degree=2, free=("z",), heat=None, motion=None
):
    """Block pressed on a block that slides along x; conductance None: perfect contact."""
    wear = FaceWear(PowerWear(1e-14, 1.0, 1.0))
    return Model(
        kinematics="3d",
        bodies=(
            Body("upper", {"upper": UPPER}, fixed=("upper_end",)),
            Body("lower", {"lower": LOWER}, fixed=("lower_end",)),
        ),
        interfaces=(
            Interface(
                faces=("upper_face", "lower_face"),
                motion=motion or Motion(velocity=SPEED),
                friction=Constant(FRICTION),
                conductance=None if conductance is None else Constant(conductance),
                wear={0: wear},
            ),
        ),
        holders=(
            Holder(
                load_direction=(0.0, 0.0, -1.0),
                pivot=(0.02, 0.015, 0.0),
                point=(0.02, 0.015, 0.0),
                free=free,
                force=FORCE,
            ),
        ),
        meshes=meshes,
        discretisation=Discretisation(degree, solver=solver),
        heat=Heat(cooling=COOLING) if heat is None else heat,
    )
