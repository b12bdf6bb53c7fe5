"""Base of geometries of two stacked rectangles: a ring on a plate, a block on a strip.

The contact lies at y = 0; body 1 is above. The mesh is structured in columns and rows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ...case.tables.geometry import Geometry
from ..mesh.gmsh_session import gmsh_model, tagged_mesh
from ..mesh.tagged import TaggedMesh
from ..meshing.blocks import Grid, Interval, add_grid, growing_from_both, smallest
from ..meshing.divided_face import divided_face

Beside = tuple[list[Interval], list[Interval]]


@dataclass(frozen=True)
class Rectangle:
    """Rectangle: x (or radius) at its left and right, and its height [m]."""

    left: float
    right: float
    height: float


class Stacked(Geometry):
    """Base class: both bodies are rectangles; body 2 is as wide as the face, or wider.

    Attributes
    ----------
    surfaces : tuple of str
        Face, top, left and right of body 1; face, bottom and right of body 2, then, if named, its
        left and the rest of its top.
    cell_order : int
        Geometric order of the cells.
    """

    name: ClassVar[str] = ""

    @property
    def cell_order(self) -> int:
        return 1

    @property
    def upper(self) -> Rectangle:
        """Section of body 1."""
        raise NotImplementedError

    @property
    def lower(self) -> Rectangle:
        """Section of body 2."""
        raise NotImplementedError

    @property
    def lower_face(self) -> tuple[float, float]:
        """Ends of the face of body 2 [m]."""
        return self.upper.left, self.upper.right

    @property
    def follows_contact(self) -> bool:
        return True  # faces may separate thermally, body 1 may tilt by friction

    def build(self, mesh, zone=None) -> TaggedMesh:
        with gmsh_model(self.name) as gmsh:
            upper = self._upper(gmsh.model, zone, *mesh.face(self.bodies[0]))
            lower, face, rest = self._lower(gmsh.model, zone, *mesh.face(self.bodies[1]))
            gmsh.model.geo.synchronize()
            parts = [upper.bottom, upper.top, upper.left, upper.right]
            parts += [face, lower.bottom, lower.right, lower.left, rest]
            for body, made in zip(self.bodies, (upper, lower), strict=True):
                gmsh.model.addPhysicalGroup(2, made.surfaces, name=body)
            for surface, curves in zip(self.surfaces, parts, strict=False):
                gmsh.model.addPhysicalGroup(1, curves, name=surface)
            gmsh.model.mesh.generate(2)
            gmsh.model.mesh.setOrder(self.cell_order)
            return tagged_mesh(gmsh.model, self.bodies, self.surfaces)

    def _upper(self, model, zone, elements: int, grading: float) -> Grid:
        columns = self._face(elements, grading, zone)
        contact, support, largest = self._sizes(columns, elements)
        rows = growing_from_both(0.0, self.upper.height, (contact, support), grading, largest)
        return add_grid(model, columns, rows)

    def _lower(self, model, zone, elements: int, grading: float):
        """Body 2 in gmsh, the curves of its contact face, and those beside it."""
        face = self._lower_face(elements, grading, zone)
        contact, support, largest = self._sizes(face, elements)
        before, after = self._beside((contact, support, largest), elements, grading)
        rows = growing_from_both(-self.lower.height, 0.0, (support, contact), grading, largest)
        made = add_grid(model, before + face + after, rows)
        start, end = len(before), len(before) + len(face)
        return made, made.top[start:end], made.top[:start] + made.top[end:]

    def _beside(self, sizes: tuple[float, float, float], elements: int, grading: float) -> Beside:
        """Divisions of body 2 on the left and on the right of the face, see `_sizes`."""
        contact, support, largest = sizes
        (left, right), (start, end) = (self.lower.left, self.lower.right), self.lower_face
        return (
            growing_from_both(left, start, (support, contact), grading, largest),
            growing_from_both(end, right, (contact, support), grading, largest),
        )

    def _lower_face(self, elements: int, grading: float, zone) -> list[Interval]:
        """Division of the face of body 2."""
        return self._face(elements, grading, zone)

    def _face(self, elements: int, grading: float, zone) -> list[Interval]:
        return divided_face(self.upper.left, self.upper.right, elements, grading, zone)

    def _sizes(self, face: list[Interval], elements: int) -> tuple[float, float, float]:
        """Element sizes at the contact edges, at the clamped edges, and the largest elsewhere.

        Clamped edges are singular too; being remote they need fewer thin elements.
        """
        upper = self.upper
        contact = smallest(face)
        largest = max(upper.right - upper.left, upper.height) * 3.0 / elements
        return contact, (contact * largest) ** 0.5, largest
