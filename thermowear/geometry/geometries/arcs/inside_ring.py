"""Ring segment on a disk, and drum brake: a ring sector pressed outwards on a ring.

The centre of both is the origin (section across the axis).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import replace
from typing import Literal

import numpy as np
from pydantic import model_validator

from ....case.tables.geometry import keyed
from ....case.values.section import KeyFault
from ....case.values.units import Coordinate, Length
from ...meshing.cells import Sheet
from ...meshing.polar import Division
from .arc_contact import ORIGIN, ArcContact, degrees

_STEEPEST = math.radians(85.0)
_LONGEST = math.radians(170.0)
_ON_THE_LINE = 1e-9
"""Moment arm, relative to the pivot's distance, that is zero up to rounding."""


class InsideRing(ArcContact):
    """Base class: body 1 is held on its inner arc."""

    @property
    @abstractmethod
    def layers(self) -> tuple[float, ...]:
        """Radial thicknesses of body 1, from its face inwards [m]."""

    @property
    def held_radius(self) -> float:
        return self.radius - sum(self.layers)

    def upper_sheets(self, division: Division) -> list[Sheet]:
        length = self.radius * float(np.ptp(self.arc))
        layers = division.layered(self.layers, length)
        return [ORIGIN.sheet(division.angles, self.radius - depths) for depths in layers]

    def on_holder(self):
        return ORIGIN.circle(self.held_radius)


class RingSegmentOnDisk(InsideRing):
    """Dimensions of a ring segment and a ring-shaped disk; the segment is pressed upwards.

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


class DrumBrake(InsideRing):
    """Dimensions of a brake shoe with lining and of the drum that it presses on.

    The shoe rotates about a pivot.

    Attributes
    ----------
    drum_radius, drum_thickness : float
        Inner radius of the drum, where the lining touches, and its radial thickness [m].
    lining_thickness, shoe_thickness : float
        Radial thicknesses [m].
    pivot : tuple of float
        Centre of rotation of the shoe; an end of the lining may lie on the line through it and the
        centre, where a rotation has no normal component [m].
    """

    name = "drum-brake"
    bodies = ("shoe", "drum")
    held = "shoe_inside"
    fixed = "drum_rim"
    rest = "drum_inside"
    circle = "drum_radius"
    zones = {"lining": "shoe"}

    type: Literal["drum-brake"]
    drum_radius: Length
    drum_thickness: Length
    lining_thickness: Length
    shoe_thickness: Length
    pivot: tuple[Coordinate, Coordinate]

    @model_validator(mode="after")
    def _fits(self):
        if not self.arc_end - self.arc_start <= _LONGEST:
            raise KeyFault(
                "arc_end",
                f"the lining covers {degrees(self.arc_end - self.arc_start)} of the drum; must be "
                f"at most {degrees(_LONGEST)}",
            )
        if not self.held_radius > 0:
            raise KeyFault(
                "shoe_thickness",
                f"{self.shoe_thickness:g} m and the lining must be thinner together than "
                f"drum_radius {self.drum_radius:g} m",
            )
        self._check_pivot()
        return self

    def _check_pivot(self) -> None:
        if not math.hypot(*self.pivot) < self.drum_radius:
            raise KeyFault(
                "pivot",
                f"lies {math.hypot(*self.pivot):g} m from the centre; must be less than "
                f"drum_radius {self.drum_radius:g} m",
            )
        ends = [self.normal_arm(angle) for angle in self.arc]
        rounding = _ON_THE_LINE * math.hypot(*self.pivot)
        outwards = min(ends) >= -rounding and max(ends) > rounding
        inwards = max(ends) <= rounding and min(ends) < -rounding
        if not outwards and not inwards:
            raise KeyFault(
                "pivot",
                f"lies at {degrees(math.atan2(*self.pivot))} clockwise from 12 o'clock (+y); must "
                f"lie neither within the lining, {degrees(self.arc_start)} to "
                f"{degrees(self.arc_end)}, nor opposite to it, except at its ends: a "
                "rotation would "
                "press one part of the shoe and lift the other",
            )

    def normal_arm(self, angle: float) -> float:
        """Outward motion of the shoe's face per anticlockwise rotation about the pivot [m/rad]."""
        x, y = self.pivot
        return y * math.sin(angle) - x * math.cos(angle)

    @keyed
    def pivot_point(self) -> tuple[float, float]:
        return self.pivot

    @keyed
    def press_direction(self) -> tuple[float, float]:
        """Outward direction at the middle of the lining."""
        middle = (self.arc_start + self.arc_end) / 2
        return math.sin(middle), math.cos(middle)

    @property
    def far_radius(self) -> float:
        return self.drum_radius + self.drum_thickness

    @property
    def layers(self) -> tuple[float, ...]:
        return self.lining_thickness, self.shoe_thickness

    def upper_sheets(self, division: Division) -> list[Sheet]:
        lining, shoe = super().upper_sheets(division)
        return [replace(lining, zone="lining"), shoe]
