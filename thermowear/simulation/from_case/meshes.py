"""Meshes of the geometry of a case."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...case.tables.geometry import Geometry, Pressing
from ...case.tables.schema import Case, MeshTable
from ...geometry.mesh.tagged import TaggedMesh
from ...model.meshes import Zone


@dataclass(frozen=True)
class CaseMeshes:
    """Source of the meshes of a case, see `model.meshes.MeshSource`.

    Attributes
    ----------
    kinematics : str
    geometry : Geometry
    settings : MeshTable
    case : Case
        Case that the mesh is checked against.
    """

    kinematics: str
    geometry: Geometry
    settings: MeshTable
    case: Case = field(compare=False, repr=False)

    @property
    def path(self) -> str | None:
        return self.geometry.path if self.geometry.from_file else None  # type: ignore[attr-defined]

    def mesh(self, zone: Zone | None) -> TaggedMesh:
        return self.case.tagged_mesh(zone)

    def expected_zone(
        self, force: float | None, approach: float | None, modulus: float
    ) -> Zone | None:
        return self.geometry.expected_zone(Pressing(force, approach, modulus))
