"""Two stacked rectangles: base of a ring on a plate, a block on a strip; blocks of equal width.

The contact lies at y = 0; body 1 is above. The mesh is structured in columns and rows.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from ...case.tables.geometry import Geometry, named
from ...case.tables.plane_geometry import PlaneGeometry
from ...case.values.units import Length
from ..mesh.tagged import TaggedMesh
from ..meshing.cells import Sheet, between, both, every, grid, level, mesh_body, tagged_bodies
from ..meshing.divisions import SAME, divided_face, growing, growing_from_both, joined

FirstRow: TypeAlias = "Callable[[float], float]"
"""Height of the first row at the face by that without a thinner skin [m]."""

_THIN_ROWS = 3
"""Graded rows of stacked blocks at the contact, for the thermal boundary layer and waves on it."""


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

    has_skin = True

    @property
    def cell_order(self) -> int:
        return 1

    @property
    @abstractmethod
    def upper(self) -> Rectangle:
        """Section of body 1."""

    @property
    @abstractmethod
    def lower(self) -> Rectangle:
        """Section of body 2."""

    @property
    def lower_face(self) -> tuple[float, float]:
        """Ends of the face of body 2 [m]."""
        return self.upper.left, self.upper.right

    @property
    def follows_contact(self) -> bool:
        return True  # faces may separate thermally, body 1 may tilt by friction

    @property
    def covers(self) -> bool:
        """True if the face is as wide as body 2, without a free part of its top."""
        (start, end), lower = self.lower_face, self.lower
        return math.isclose(end - start, lower.right - lower.left, rel_tol=SAME)

    def build(self, mesh, zone=None) -> TaggedMesh:
        (first, upper), (second, lower) = zip(self.bodies, (self.upper, self.lower), strict=True)
        ends = {
            first: self._upper(zone, mesh.row, *mesh.face(first)),
            second: self._lower(zone, mesh.row, *mesh.face(second)),
        }
        at_face = level(1, 0.0)
        claims = [at_face, level(1, upper.height), level(0, upper.left), level(0, upper.right)]
        claims += [both(at_face, between(*self.lower_face)), level(1, -lower.height)]
        claims += [level(0, lower.right), level(0, lower.left), at_face]
        return tagged_bodies(
            {body: mesh_body([Sheet(grid(*of))], self.cell_order) for body, of in ends.items()},
            dict(zip(self.surfaces, claims, strict=False)),
        )

    def _upper(
        self, zone, row: FirstRow, elements: int, grading: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Columns and rows of body 1."""
        columns = self._face(elements, grading, zone)
        contact, support, largest = self._sizes(columns, elements)
        rows = growing_from_both(0.0, self.upper.height, (row(contact), support), grading, largest)
        return columns, rows

    def _lower(
        self, zone, row: FirstRow, elements: int, grading: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Columns and rows of body 2."""
        face = self._lower_face(elements, grading, zone)
        contact, support, largest = self._sizes(face, elements)
        before, after = self._beside((contact, support, largest), elements, grading)
        first = support, row(contact)
        rows = growing_from_both(-self.lower.height, 0.0, first, grading, largest)
        return joined(before, face, after), rows

    def _beside(
        self, sizes: tuple[float, float, float], elements: int, grading: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Divisions of body 2 on the left and on the right of the face, see `_sizes`."""
        contact, support, largest = sizes
        (left, right), (start, end) = (self.lower.left, self.lower.right), self.lower_face
        return (
            growing_from_both(left, start, (support, contact), grading, largest),
            growing_from_both(end, right, (contact, support), grading, largest),
        )

    def _lower_face(self, elements: int, grading: float, zone) -> np.ndarray:
        """Division of the face of body 2."""
        return self._face(elements, grading, zone)

    def _face(self, elements: int, grading: float, zone) -> np.ndarray:
        return divided_face(self.upper.left, self.upper.right, elements, grading, zone)

    def _sizes(self, face: np.ndarray, elements: int) -> tuple[float, float, float]:
        """Element sizes at the contact edges, at the clamped edges, and the largest elsewhere.

        Clamped edges are singular too; being remote they need fewer thin elements.
        """
        upper, contact = self.upper, float(np.diff(face).min())
        largest = max(upper.right - upper.left, upper.height) * 3.0 / elements
        return contact, (contact * largest) ** 0.5, largest


class StackedBlocks(PlaneGeometry):
    """Dimensions of two blocks of equal width between planes of symmetry.

    A column of bodies that are wide and uniform, or half a wavelength of a state that is periodic
    along x, from x = 0 to the width. Sliding is normal to the section: friction heats and wears the
    blocks, without tangential traction in the section.

    There is no singularity where the face meets a plane of symmetry: its elements are equal.
    There are about as many rows as elements along the face, and some thin ones at the contact.

    Attributes
    ----------
    width : float
        Width of both blocks [m].
    upper_height : float
        Height of the upper block [m].
    lower_height : float
        Height of the lower block [m].
    """

    name = "stacked-blocks"
    models = ("plane-strain", "plane-stress")
    bodies = ("upper", "lower")
    surfaces = (*named("upper", "face", "top", "side"), *named("lower", "face", "bottom", "side"))
    symmetry = ("upper_side", "lower_side")
    held = "upper_top"
    fixed = "lower_bottom"
    slides_across = True
    has_skin = True

    type: Literal["stacked-blocks"]
    width: Length
    upper_height: Length
    lower_height: Length

    def contact_area(self) -> float:
        return self.width * self.thickness

    def build(self, mesh, zone=None):
        blocks, claims = {}, []
        ends = self.upper_height, -self.lower_height
        for body, end in zip(self.bodies, ends, strict=True):
            elements, grading = mesh.face(body)
            largest = abs(end) / elements
            thin = mesh.row(largest * grading**_THIN_ROWS)
            rows = growing(0.0, end, thin, grading, largest)
            columns = np.linspace(0.0, self.width, elements + 1)
            blocks[body] = mesh_body([Sheet(grid(columns, rows))], order=1)
            claims += [level(1, 0.0), level(1, end), every]
        return tagged_bodies(blocks, dict(zip(self.surfaces, claims, strict=True)))
