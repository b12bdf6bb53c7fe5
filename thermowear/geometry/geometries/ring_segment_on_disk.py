"""Ring segment pressed upwards on the inside of a rotating, ring-shaped disk.

The centre of both is the origin (section across the axis).
"""

from __future__ import annotations

import math
from typing import Literal

from pydantic import model_validator

from ...case.values.units import Length
from .inside_ring import InsideRing

_STEEPEST = math.radians(85.0)


class RingSegmentOnDisk(InsideRing):
    """Dimensions of segment and disk.

    Attributes
    ----------
    disk_radius, disk_outer_radius : float
        Inner radius of the disk, where they touch, and its outer radius [m].
    segment_thickness : float
        Radial thickness [m].
    """

    name = "ring-segment-on-disk"
    bodies = ("segment", "disk")
    held = "segment_inside"
    fixed = "disk_rim"
    rest = "disk_inside"
    far_circle = "disk_outer_radius"
    press_direction = (0.0, 1.0)

    type: Literal["ring-segment-on-disk"]
    disk_radius: Length
    disk_outer_radius: Length
    segment_thickness: Length

    @model_validator(mode="after")
    def _fits(self):
        self.check_arc(_STEEPEST)
        self.check_greater("disk_outer_radius", "disk_radius")
        self.check_less("segment_thickness", "disk_radius")
        return self

    @property
    def layers(self) -> tuple[float, ...]:
        return (self.segment_thickness,)
