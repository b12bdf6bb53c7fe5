"""An annular punch turning about its axis on a plate (half section, r and z).

The contact lies at z = 0; the punch is above, the plate below.
"""

from __future__ import annotations

import math
from typing import Literal

from pydantic import model_validator

from ..case.geometry import Geometry
from ..case.section import KeyFault
from ..case.units import Length
from .blocks import Interval, add_grid, graded_face, growing, growing_from_both, smallest
from .gmsh_session import gmsh_model, tagged_mesh
from .tagged import TaggedMesh

_APART = 1e-6  # of the outer radius: an edge of contact nearer to the face's edge is the same


class AnnularPunch(Geometry):
    """Sizes of punch and plate [m]."""

    name = "annular-punch"
    models = ("axisymmetric",)
    bodies = ("punch", "plate")
    surfaces = (
        "punch_face",
        "punch_top",
        "punch_inside",
        "punch_outside",
        "plate_face",
        "plate_bottom",
        "plate_side",
    )
    contact = ("punch_face", "plate_face")
    held = "punch_top"
    fixed = "plate_bottom"

    type: Literal["annular-punch"]
    inner_radius: Length
    outer_radius: Length
    punch_height: Length
    plate_radius: Length
    plate_height: Length

    @model_validator(mode="after")
    def _nested(self):
        if not self.inner_radius < self.outer_radius:
            raise KeyFault(
                "inner_radius",
                f"{self.inner_radius:g} m must be less than outer_radius {self.outer_radius:g} m",
            )
        if not self.outer_radius < self.plate_radius:
            raise KeyFault(
                "plate_radius",
                f"{self.plate_radius:g} m must be greater than "
                f"outer_radius {self.outer_radius:g} m",
            )
        return self

    @property
    def follows_contact(self) -> bool:
        return True  # heat can part the faces

    def contact_area(self) -> float:
        return math.pi * (self.outer_radius**2 - self.inner_radius**2)

    def build(self, mesh, zone=None) -> TaggedMesh:
        with gmsh_model(self.name) as gmsh:
            punch = self._punch(gmsh.model, zone, *mesh.face("punch"))
            plate, face = self._plate(gmsh.model, zone, *mesh.face("plate"))
            gmsh.model.geo.synchronize()
            parts = {
                "punch_face": punch.bottom,
                "punch_top": punch.top,
                "punch_inside": punch.left,
                "punch_outside": punch.right,
                "plate_face": face,
                "plate_bottom": plate.bottom,
                "plate_side": plate.right,
            }
            gmsh.model.addPhysicalGroup(2, punch.surfaces, name="punch")
            gmsh.model.addPhysicalGroup(2, plate.surfaces, name="plate")
            for name in self.surfaces:
                gmsh.model.addPhysicalGroup(1, parts[name], name=name)
            gmsh.model.mesh.generate(2)
            return tagged_mesh(gmsh.model, self.bodies, self.surfaces)

    def _punch(self, model, zone, elements: int, grading: float):
        columns = self._face(elements, grading, zone)
        contact, support, largest = self._sizes(columns, elements)
        rows = growing_from_both(0.0, self.punch_height, (contact, support), grading, largest)
        return add_grid(model, columns, rows)

    def _plate(self, model, zone, elements: int, grading: float):
        face = self._face(elements, grading, zone)
        contact, support, largest = self._sizes(face, elements)
        inside = growing(self.inner_radius, 0.0, contact, grading, largest)
        outside = growing_from_both(
            self.outer_radius, self.plate_radius, (contact, support), grading, largest
        )
        rows = growing_from_both(-self.plate_height, 0.0, (support, contact), grading, largest)
        columns: list[Interval] = inside + face + outside
        plate = add_grid(model, columns, rows)
        inner = len(inside)
        return plate, plate.top[inner : inner + len(face)]

    def _face(self, elements: int, grading: float, zone) -> list[Interval]:
        """The contact face, graded to its edges, or to those of a contact that ends inside it."""
        inner, outer = self.inner_radius, self.outer_radius
        if zone is None:
            return graded_face(inner, outer, elements, grading)
        start, end = max(zone[0], inner), min(zone[1], outer)
        face = graded_face(start, end, elements, grading)
        size, largest = smallest(face), (end - start) / elements
        if start - inner > _APART * outer:
            face = growing_from_both(inner, start, (size, size), grading, largest) + face
        if outer - end > _APART * outer:
            face = face + growing_from_both(end, outer, (size, size), grading, largest)
        return face

    def _sizes(self, face: list[Interval], elements: int) -> tuple[float, float, float]:
        """Element sizes at the contact edges, at the clamped edges, and elsewhere at most.

        Clamped edges are singular too; being remote they need fewer thin elements.
        """
        contact, largest = smallest(face), self._largest(elements)
        return contact, (contact * largest) ** 0.5, largest

    def _largest(self, elements: int) -> float:
        """Largest element away from the contact."""
        return max(self.outer_radius - self.inner_radius, self.punch_height) * 3.0 / elements
