"""Source of the meshes of a model."""

from __future__ import annotations

from typing import Protocol

from ..geometry.mesh.tagged import TaggedMesh

Zone = tuple[float, float]
"""Range of x [m]."""


class MeshSource(Protocol):
    """Mesh of the bodies with named parts and surfaces; sources of equal meshes compare equal.

    Attributes
    ----------
    path : str or None
        File that the mesh is read from: it is identified by a checksum. None for built meshes.
    """

    @property
    def path(self) -> str | None: ...

    def mesh(self, zone: Zone | None) -> TaggedMesh:
        """Mesh for a contact zone, by default the expected one; called on rank 0.

        Raises
        ------
        CaseError
            If it cannot be made.
        """
        ...

    def expected_zone(
        self, force: float | None, approach: float | None, modulus: float
    ) -> Zone | None:
        """Estimate of the contact zone, for which the mesh is refined; None if it has no zone.

        A face may reach beyond its zone: a contact that comes near its end has outgrown the mesh.

        Parameters
        ----------
        force : float or None
            Normal force [N].
        approach : float or None
            Approach of body 1 [m].
        modulus : float
            Contact modulus E*, ``1/E* = Σ (1 - ν²)/E`` [Pa].
        """
        ...
