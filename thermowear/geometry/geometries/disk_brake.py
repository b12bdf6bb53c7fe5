"""Brake pads on a rotating disk (half section, r and z).

The contact lies at z = 0; the pad is above. The disk is symmetric about its middle, with pads on
both sides; its upper half is meshed.

Deformation and temperature are those of a pad covering the full circumference; resultants on
the pads, which cover a sector, are those of the ring times that sector. Pressure and rigid motions
are therefore exact, while the ends of the pads are neglected in the elasticity.
"""

from __future__ import annotations

import math
from typing import Literal

from ...case.tables.geometry import keyed, named
from ..meshing.blocks import SAME
from .pads_on_disk import PadsOnDisk
from .stacked import Rectangle, Stacked


class DiskBrake(PadsOnDisk, Stacked):
    """Dimensions of pads and disk, see the base.

    The middle plane of the disk is constrained axially only: it is both fixed and on rollers.
    """

    name = "disk-brake"
    models = ("axisymmetric",)
    widest_pad = 360.0
    rollers = ("disk_middle",)

    type: Literal["disk-brake"]

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        disk = named("disk", "face", "middle", "outside", "inside")
        rest = () if self.covers_disk else ("disk_rest",)
        return *named("pad", "face", "back", "inside", "outside"), *disk, *rest

    @property
    def covers_disk(self) -> bool:
        """True if the pads are as wide as the disk, so that no free ring of its face remains."""
        return math.isclose(
            self.pad_inner_radius, self.disk_inner_radius, rel_tol=SAME
        ) and math.isclose(self.pad_outer_radius, self.disk_outer_radius, rel_tol=SAME)

    @property
    def upper(self) -> Rectangle:
        return Rectangle(self.pad_inner_radius, self.pad_outer_radius, self.pad_thickness)

    @property
    def lower(self) -> Rectangle:
        return Rectangle(self.disk_inner_radius, self.disk_outer_radius, self.disk_thickness / 2)

    @keyed
    def sector(self) -> float:
        return self.pad_angle / (2 * math.pi)
