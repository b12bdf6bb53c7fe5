"""Cylinder pressed on a block, or sliding along it (section across the cylinder).

They touch at the origin; the cylinder is above. Its lower half is meshed.
"""

from __future__ import annotations

import math
from typing import Literal

from ...case.tables.geometry import Pressing
from .on_block import PlaneOnBlock
from .round_on_block import RoundOnBlock


class CylinderOnBlock(RoundOnBlock, PlaneOnBlock):
    """Dimensions of cylinder and block, see the bases."""

    name = "cylinder-on-block"
    bodies = ("cylinder", "block")

    type: Literal["cylinder-on-block"]

    def unworn_half_width(self, pressing: Pressing) -> float:
        if pressing.force is not None:  # Hertz
            line_load = pressing.force / self.thickness
            return math.sqrt(4 * line_load * self.radius / (math.pi * pressing.modulus))
        assert pressing.approach is not None
        return 0.7 * math.sqrt(self.radius * pressing.approach)
