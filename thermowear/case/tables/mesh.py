"""Table ``mesh``: discretisation of the bodies."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ...errors import CaseError
from ..values.percentages import Percentage
from ..values.section import Number, Section
from ..values.units import Length

_MOST_NODES = 2_000_000
"""Largest number of displacement nodes: larger matrices exceed the memory of a workstation."""

MOST_ELEMENTS = 2000
Elements = Annotated[int, Field(ge=1, le=MOST_ELEMENTS, strict=True)]
Grading = Annotated[Number, Field(ge=0.05, le=1.0)]


class FaceMesh(Section):
    """Mesh of one body where it differs from the default.

    Attributes
    ----------
    elements : int or None
        Number of elements along the contact.
    grading : float or None
        Size ratio of neighbouring elements towards the contact edges.
    size : float or None
        Largest element size of a body from CAD [m].
    contact_size : float or None
        Element size on the contact faces of a body from CAD [m].
    """

    elements: Elements | None = None
    grading: Grading | None = None
    size: Length | None = None
    contact_size: Length | None = None


class MeshTable(Section):
    """Discretisation.

    Attributes
    ----------
    degree : int
        Polynomial degree of displacement and temperature.
    elements : int
        Number of elements along the contact.
    grading : float
        Size ratio of neighbouring elements towards the contact edges; of bodies from CAD: size of
        the elements at the contact edges relative to those inside.
    size : float or None
        Largest element size of bodies from CAD, by default a small part of the size of each body
        [m].
    contact_size : float or None
        Element size on contact faces of bodies from CAD, by default half of the largest one, and
        finer where curved faces touch in a small zone [m].
    skin : float or None
        Height of the first row of elements at the contact faces, where they are thicker otherwise
        [m].
    solver : str
        Linear solver of bodies in space: ``auto`` (by size), ``direct`` or ``multigrid``.
    bodies : dict of str to FaceMesh
        Deviations for single bodies: the meshes of the faces need not match.
    accuracy : float or None
        Largest relative error of pressure, shape and temperature; those of `degree`, `elements`
        and `grading` that are not given are chosen for it.
    """

    CHOSEN: ClassVar = {"degree", "elements", "grading"}

    degree: Annotated[int, Field(ge=1, le=10, strict=True)] = 8
    elements: Elements = 12
    grading: Grading = 0.3
    size: Length | None = None
    contact_size: Length | None = None
    skin: Length | None = None
    solver: Literal["auto", "direct", "multigrid"] = "auto"
    bodies: dict[str, FaceMesh] = {}
    accuracy: Percentage | None = None

    def face(self, body: str) -> tuple[int, float]:
        """Number of elements along the contact, and grading, of one body."""
        own = self.bodies.get(body, FaceMesh())
        return own.elements or self.elements, own.grading or self.grading

    def row(self, height: float) -> float:
        """Height of the first row of elements at a contact face, one without `skin` given [m]."""
        return height if self.skin is None else min(height, self.skin)

    def sizes(self, body: str) -> tuple[float | None, float | None]:
        """Largest element size of one body, and that on its contact faces [m]."""
        own = self.bodies.get(body, FaceMesh())
        return own.size or self.size, own.contact_size or self.contact_size


def check_size(mesh, degree: int) -> None:
    """Reject a mesh with more nodes than can be computed.

    Raises
    ------
    CaseError
    """
    cells = sum(len(block.cells) for block in mesh.blocks)
    nodes = sum(
        # five or six tetrahedra fill a hexahedron
        len(block.cells) / (5 if block.cell_type == "tetrahedron" else 1)
        for block in mesh.blocks
    )
    nodes *= degree ** mesh.points.shape[1]
    if nodes > _MOST_NODES:
        raise CaseError(
            f"mesh: {cells} cells of degree {degree} have about {nodes / 1e6:.2g} million nodes; "
            f"at most {_MOST_NODES / 1e6:g} million can be computed; check the units of the "
            "geometry, or lower mesh.elements or mesh.degree"
        )
