"""Rectangular punch on a block, in space.

The contact lies at z = 0 and is centred at the origin; the punch is above. Sides are parallel to
x and y.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from pydantic import model_validator

from ...case.tables.geometry import Geometry, named
from ...case.values.section import KeyFault
from ...case.values.units import Distance, Length
from ..meshing.cells import (
    MeshedBody,
    between,
    both,
    every,
    level,
    mesh_lattice,
    tagged_bodies,
)
from ..meshing.divisions import graded_face, growing, joined


class RectangularPunch(Geometry):
    """Dimensions of punch and block.

    ``mesh.elements`` is the number along the longer side of the contact; the shorter has fewer.

    Attributes
    ----------
    size_x : float
        Size of the punch along x [m].
    size_y : float
        Size of the punch along y [m].
    height : float
        Height of the punch [m].
    block_x : float
        Size of the block along x [m].
    block_y : float
        Size of the block along y [m].
    block_height : float
        Height of the block [m].
    stroke : float
        Amplitude of a punch that reciprocates along x: the block is meshed for contact over the
        whole stroke [m].
    """

    name = "rectangular-punch"
    models = ("3d",)
    bodies = ("punch", "block")
    surfaces = (
        *named("punch", "face", "top", "sides"),
        *named("block", "face", "top", "bottom", "sides"),
    )
    press_direction = (0.0, 0.0, -1.0)
    held = "punch_top"
    fixed = "block_bottom"

    type: Literal["rectangular-punch"]
    size_x: Length
    size_y: Length
    height: Length
    block_x: Length
    block_y: Length
    block_height: Length
    stroke: Distance = 0.0

    @model_validator(mode="after")
    def _fits(self):
        for axis, stroke in (("x", self.stroke), ("y", 0.0)):
            size, block = getattr(self, f"size_{axis}"), getattr(self, f"block_{axis}")
            if not size + 2 * stroke < 0.9 * block:
                and_stroke = f" and twice the stroke {stroke:g} m" if stroke else ""
                raise KeyFault(
                    f"block_{axis}",
                    f"{block:g} m must be greater than 10/9 of size_{axis} {size:g} m{and_stroke}",
                )
        return self

    def contact_area(self) -> float:
        return self.size_x * self.size_y

    def build(self, mesh, zone=None):
        at_face, (x, y) = level(2, 0.0), (self.size_x / 2 + self.stroke, self.size_y / 2)
        return tagged_bodies(
            {
                "punch": self._punch(*mesh.face("punch")),
                "block": self._block(*mesh.face("block")),
            },
            {
                "punch_face": at_face,
                "punch_top": level(2, self.height),
                "punch_sides": every,
                "block_face": both(at_face, between(-x, x), between(-y, y, axis=1)),
                "block_top": at_face,
                "block_bottom": level(2, -self.block_height),
                "block_sides": every,
            },
        )

    def _punch(self, elements: int, grading: float) -> MeshedBody:
        x, y, thin, largest = self._face(elements, grading)
        z = growing(0.0, self.height, thin, grading, largest)
        return mesh_lattice((x, y, z), 1)

    def _block(self, elements: int, grading: float) -> MeshedBody:
        *faces, thin, largest = self._face(elements, grading)
        if self.stroke > 0.0:  # the ends of the punch move over the face: uniform elements
            end = self.size_x / 2 + self.stroke
            faces[0] = np.linspace(
                -end, end, round((len(faces[0]) - 1) * 2 * end / self.size_x) + 1
            )
        x, y = (
            joined(
                growing(-face[-1], -block / 2, thin, grading, largest),
                face,
                growing(face[-1], block / 2, thin, grading, largest),
            )
            for face, block in zip(faces, (self.block_x, self.block_y), strict=True)
        )
        z = growing(0.0, -self.block_height, thin, grading, largest)
        return mesh_lattice((x, y, z), 1)

    def _face(self, elements: int, grading: float) -> tuple[np.ndarray, np.ndarray, float, float]:
        """Divisions of the contact along x and along y.

        Also the element size next to the contact edges, and the largest one far away [m].
        """
        longest = max(self.size_x, self.size_y)
        x, y = (
            graded_face(-size / 2, size / 2, max(1, round(elements * size / longest)), grading)
            for size in (self.size_x, self.size_y)
        )
        return x, y, float(min(np.diff(x).min(), np.diff(y).min())), 3.0 * longest / elements
