"""Sphere pressed on a cylindrical block, or rotating on it (half section, r and z).

They touch at the origin; the sphere is above. Its lower half is meshed.
"""

from __future__ import annotations

import math
from typing import ClassVar, Literal

from ...case.tables.geometry import Pressing
from ...case.values.units import Length
from .round_on_block import RoundOnBlock


class SphereOnBlock(RoundOnBlock):
    """Dimensions of sphere and block.

    Attributes
    ----------
    block_radius : float [m]
    """

    name = "sphere-on-block"
    models = ("axisymmetric",)
    bodies = ("sphere", "block")
    block_key = "block_radius"
    slides_across: ClassVar[bool] = True

    type: Literal["sphere-on-block"]
    block_radius: Length

    @property
    def block_reach(self) -> float:
        return self.block_radius

    def unworn_half_width(self, pressing: Pressing) -> float:
        if pressing.force is not None:  # Hertz
            return (3 * pressing.force * self.radius / (4 * pressing.modulus)) ** (1 / 3)
        assert pressing.approach is not None
        return math.sqrt(self.radius * pressing.approach)
