"""Brake pads on a disk that turns (half section, r and z).

The contact lies at z = 0; the pad is above. The disk is symmetric about its middle, with pads on
both sides; its upper half is meshed.

Deformation and temperature are those of a pad that goes all the way round; what acts on the pads,
which take up a sector of it, is the ring's times that sector. So the pressure and the rigid motions
are exact, and the ends of the pads are left out of the elasticity.
"""

from __future__ import annotations

import math
from typing import Literal

from ...case.tables.geometry import keyed
from ..meshing.blocks import SAME
from .pads_on_disk import PadsOnDisk
from .stacked import Section, Stacked


class DiskBrake(PadsOnDisk, Stacked):
    """Sizes of pads and disk, see the base.

    The middle of the disk is held along the axis only: it is both fixed and on rollers.
    """

    name = "disk-brake"
    models = ("axisymmetric",)
    widest_pad = 360.0

    type: Literal["disk-brake"]

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        pad = (f"pad_{part}" for part in ("face", "back", "inside", "outside"))
        disk = (f"disk_{part}" for part in ("face", "middle", "outside", "inside"))
        return *pad, *disk, *(() if self.covers_disk else ("disk_rest",))

    @property
    def covers_disk(self) -> bool:
        """Whether the pads are as wide as the disk, which leaves no free ring of its face."""
        return math.isclose(
            self.pad_inner_radius, self.disk_inner_radius, rel_tol=SAME
        ) and math.isclose(self.pad_outer_radius, self.disk_outer_radius, rel_tol=SAME)

    @property
    def upper(self) -> Section:
        return Section(self.pad_inner_radius, self.pad_outer_radius, self.pad_thickness)

    @property
    def lower(self) -> Section:
        return Section(self.disk_inner_radius, self.disk_outer_radius, self.disk_thickness / 2)

    @property
    def rollers(self) -> tuple[str, ...]:
        return ("disk_middle",)

    @property
    def sector(self) -> float:
        return self.pad_angle / (2 * math.pi)
