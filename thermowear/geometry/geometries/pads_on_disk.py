"""Base of disk brake geometries: as a ring in a half section, and in space."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import ClassVar

from pydantic import model_validator

from ...case.tables.geometry import Geometry
from ...case.values.section import KeyFault
from ...case.values.units import Angle, Length
from ..meshing.blocks import SAME


class PadsOnDisk(Geometry):
    """Base class: a disk, symmetric about its middle, of which the upper half is meshed.

    Attributes
    ----------
    pad_inner_radius, pad_outer_radius, pad_thickness : float [m]
    pad_angle : float
        Angle covered by all pads on one side of the disk [rad].
    disk_inner_radius, disk_outer_radius : float
        Radii of the disk, which must enclose those of the pads [m].
    disk_thickness : float
        Thickness of the whole disk, half of which is meshed [m].
    widest_pad : float
        Largest `pad_angle` that can be meshed [deg].
    """

    name: ClassVar[str] = ""
    bodies = ("pad", "disk")
    held = "pad_back"
    fixed = "disk_middle"
    widest_pad: ClassVar[float]

    pad_inner_radius: Length
    pad_outer_radius: Length
    pad_thickness: Length
    pad_angle: Angle
    disk_inner_radius: Length
    disk_outer_radius: Length
    disk_thickness: Length

    @model_validator(mode="after")
    def _nested(self):
        names = ("disk_inner_radius", "pad_inner_radius", "pad_outer_radius", "disk_outer_radius")
        for smaller, larger in pairwise(names):
            a, b = getattr(self, smaller), getattr(self, larger)
            if not a < b and larger == "pad_outer_radius":
                raise KeyFault(smaller, f"{a:g} m must be less than {larger} {b:g} m")
            if not a <= b * (1 + SAME):
                raise KeyFault(smaller, f"{a:g} m must be at most {larger} {b:g} m")
        if not 0 < self.pad_angle <= math.radians(self.widest_pad) * (1 + 1e-12):
            raise KeyFault(
                "pad_angle",
                f"{math.degrees(self.pad_angle):g} deg must be greater than 0 deg, "
                f"at most {self.widest_pad:g} deg",
            )
        return self

    def contact_area(self) -> float:
        """Area of the pads on one side."""
        return self.pad_angle / 2 * (self.pad_outer_radius**2 - self.pad_inner_radius**2)
