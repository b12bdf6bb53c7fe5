"""Two stacked blocks of equal width between planes of symmetry.

A column of bodies that are wide and uniform, or half a wavelength of a state that is periodic
along x. The contact lies at y = 0, from x = 0 to the width. Sliding is normal to the section:
friction heats and wears the blocks, without tangential traction in the section.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from ...case.tables.geometry import named
from ...case.tables.plane_geometry import PlaneGeometry
from ...case.values.units import Length
from ..meshing.cells import MeshedBody, Sheet, every, grid, level, mesh_body, tagged_bodies
from ..meshing.divisions import growing

_THIN_ROWS = 3
"""Graded rows at the contact, which resolve the thermal boundary layer and waves along the face."""


class StackedBlocks(PlaneGeometry):
    """Dimensions of both blocks.

    There is no singularity where the face meets a plane of symmetry: its elements are equal.
    There are about as many rows as elements along the face, and some thin ones at the contact.

    Attributes
    ----------
    width : float [m]
    upper_height, lower_height : float [m]
    """

    name = "stacked-blocks"
    models = ("plane-strain", "plane-stress")
    bodies = ("upper", "lower")
    surfaces = (*named("upper", "face", "top", "side"), *named("lower", "face", "bottom", "side"))
    symmetry = ("upper_side", "lower_side")
    held = "upper_top"
    fixed = "lower_bottom"
    slides_across = True

    type: Literal["stacked-blocks"]
    width: Length
    upper_height: Length
    lower_height: Length

    def contact_area(self) -> float:
        return self.width * self.thickness

    def build(self, mesh, zone=None):
        ends = {"upper": self.upper_height, "lower": -self.lower_height}
        claims = {}
        for body, end in ends.items():
            far = "top" if end > 0 else "bottom"
            claims[f"{body}_face"] = level(1, 0.0)
            claims[f"{body}_{far}"] = level(1, end)
            claims[f"{body}_side"] = every
        blocks = {body: self._block(end, *mesh.face(body)) for body, end in ends.items()}
        return tagged_bodies(blocks, claims)

    def _block(self, end: float, elements: int, grading: float) -> MeshedBody:
        """Block from the contact to y = `end`."""
        largest = abs(end) / elements
        first = largest * grading**_THIN_ROWS
        rows = growing(0.0, end, first, grading, largest)
        columns = np.linspace(0.0, self.width, elements + 1)
        return mesh_body([Sheet(grid(columns, rows))], order=1)
