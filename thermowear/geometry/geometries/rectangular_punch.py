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
from ...case.values.units import Length
from ..meshing.blocks import Interval, ends_of, graded_face, growing, smallest
from ..meshing.hexes import Lattice, level, mesh_lattice
from ..meshing.quads import MeshedBody, tagged_bodies


class RectangularPunch(Geometry):
    """Dimensions of punch and block.

    ``mesh.elements`` is the number along the longer side of the contact; the shorter has fewer.

    Attributes
    ----------
    size_x, size_y, height : float
        Dimensions of the punch [m].
    block_x, block_y, block_height : float [m]
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

    @model_validator(mode="after")
    def _fits(self):
        for axis in "xy":
            size, block = getattr(self, f"size_{axis}"), getattr(self, f"block_{axis}")
            if not size < 0.9 * block:
                raise KeyFault(
                    f"block_{axis}",
                    f"{block:g} m must be greater than 10/9 of size_{axis} {size:g} m",
                )
        return self

    def contact_area(self) -> float:
        return self.size_x * self.size_y

    def build(self, mesh, zone=None):
        bodies = {
            "punch": self._punch(*mesh.face("punch")),
            "block": self._block(*mesh.face("block")),
        }
        return tagged_bodies(
            bodies,
            {
                "punch_face": lambda p: level(p, 0.0),
                "punch_top": lambda p: level(p, self.height),
                "punch_sides": lambda p: np.ones(len(p), dtype=bool),
                "block_face": lambda p: level(p, 0.0) & self._under_punch(p),
                "block_top": lambda p: level(p, 0.0),
                "block_bottom": lambda p: level(p, -self.block_height),
                "block_sides": lambda p: np.ones(len(p), dtype=bool),
            },
        )

    def _punch(self, elements: int, grading: float) -> MeshedBody:
        x, y = self._face(elements, grading)
        thin, largest = self._sizes(x, y, elements)
        z = growing(0.0, self.height, thin, grading, largest)
        return _boxes(x, y, z)

    def _block(self, elements: int, grading: float) -> MeshedBody:
        x, y = self._face(elements, grading)
        thin, largest = self._sizes(x, y, elements)
        x, y = (
            growing(-face[-1].end, -block / 2, thin, grading, largest)
            + face
            + growing(face[-1].end, block / 2, thin, grading, largest)
            for face, block in ((x, self.block_x), (y, self.block_y))
        )
        z = growing(0.0, -self.block_height, thin, grading, largest)
        return _boxes(x, y, z)

    def _face(self, elements: int, grading: float) -> list[list[Interval]]:
        """Divisions of the contact along x and along y."""
        longest = max(self.size_x, self.size_y)
        return [
            graded_face(-size / 2, size / 2, max(1, round(elements * size / longest)), grading)
            for size in (self.size_x, self.size_y)
        ]

    def _sizes(self, x: list[Interval], y: list[Interval], elements: int) -> tuple[float, float]:
        """Element sizes next to the contact edges, and the largest ones far away [m]."""
        thin = min(smallest(x), smallest(y))
        return thin, 3.0 * max(self.size_x, self.size_y) / elements

    def _under_punch(self, p: np.ndarray) -> np.ndarray:
        half = np.array([self.size_x, self.size_y]) / 2
        return np.all(np.abs(p[..., :2].mean(axis=1)) < half, axis=1)


def _boxes(x: list[Interval], y: list[Interval], z: list[Interval]) -> MeshedBody:
    """Boxes between the element ends along the axes."""
    return mesh_lattice(Lattice((ends_of(x), ends_of(y), ends_of(z)), lambda p: p), 1)
