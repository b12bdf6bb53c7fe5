"""Block with a concave face on the rim of a rotating disk (section across the disk's axis).

The disk's centre is the origin; the block is above and is held at its flat top.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from pydantic import model_validator

from ...case.values.units import Length
from ..meshing.polar import Division
from ..meshing.quads import Sheet, grid
from .arc_contact import ArcContact
from .on_block import near

_STEEPEST = math.radians(80.0)
"""Largest angle of the arc: it makes at least 10 degrees with the block's vertical side."""


class BlockOnDisk(ArcContact):
    """Dimensions of block and disk.

    Attributes
    ----------
    disk_radius, disk_bore : float
        Radii of rim and bore [m].
    block_height : float
        Height of the block's top above the highest point of the disk [m].
    """

    name = "block-on-disk"
    bodies = ("block", "disk")
    held = "block_top"
    fixed = "disk_bore"
    rest = "disk_rim"
    far_circle = "disk_bore"

    type: Literal["block-on-disk"]
    disk_radius: Length
    disk_bore: Length
    block_height: Length

    @model_validator(mode="after")
    def _fits(self):
        self.check_arc(_STEEPEST)
        self.check_less("disk_bore", "disk_radius")
        return self

    @property
    def top(self) -> float:
        """Height of the block's top above the centre of the disk [m]."""
        return self.disk_radius + self.block_height

    def upper_sheets(self, division: Division) -> list[Sheet]:
        radius, top = self.disk_radius, self.top
        highest_side = top - radius * min(map(math.cos, self.arc))
        width = radius * float(np.ptp(np.sin(self.arc)))
        rows = division.layered((highest_side,), width)[0] / highest_side

        def place(p):
            angle, up = p[..., 0], p[..., 1]
            y = (1 - up) * radius * np.cos(angle) + up * top
            return np.stack([radius * np.sin(angle), y], axis=-1)

        return [Sheet(grid(division.angles, rows), place)]

    def on_holder(self, p):
        return near(p[..., 1], self.top, self.top)
