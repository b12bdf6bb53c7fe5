"""Brake pads on a disk that turns (half section, r and z).

The contact lies at z = 0; the pad is above. The disk is symmetric about its middle, with pads on
both sides; its upper half is meshed.

Deformation and temperature are those of a pad that goes all the way round; what acts on the pads,
which take up a sector of it, is the ring's times that sector. So the pressure and the rigid motions
are exact, and the ends of the pads are left out of the elasticity.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Literal

from pydantic import model_validator

from ..case.section import KeyFault
from ..case.units import Angle, Length
from .stacked import Section, Stacked


class DiskBrake(Stacked):
    """Sizes of pads and disk.

    The middle of the disk is held along the axis only: it is both fixed and on rollers.

    Attributes
    ----------
    pad_inner_radius, pad_outer_radius, pad_thickness : float [m]
    pad_angle : float
        That the pads on one side of the disk take up together [rad].
    disk_inner_radius, disk_outer_radius : float [m]
    disk_thickness : float
        Of the whole disk [m].
    """

    name = "disk-brake"
    models = ("axisymmetric",)
    bodies = ("pad", "disk")
    surfaces = (
        "pad_face",
        "pad_back",
        "pad_inside",
        "pad_outside",
        "disk_face",
        "disk_middle",
        "disk_outside",
        "disk_inside",
        "disk_rest",
    )
    contact = ("pad_face", "disk_face")
    held = "pad_back"
    fixed = "disk_middle"

    type: Literal["disk-brake"]
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
            if not a < b:
                raise KeyFault(smaller, f"{a:g} m must be less than {larger} {b:g} m")
        if not 0 < self.sector <= 1 + 1e-12:
            raise KeyFault(
                "pad_angle",
                f"{math.degrees(self.pad_angle):g} deg must be greater than 0 deg, at most 360 deg",
            )
        return self

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

    def contact_area(self) -> float:
        """Of the pads on one side."""
        return self.pad_angle / 2 * (self.pad_outer_radius**2 - self.pad_inner_radius**2)
