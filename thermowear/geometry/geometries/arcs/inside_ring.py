"""Ring segment on a disk, and drum brake: a ring sector pressed outwards on a ring.

The centre of both is the origin (section across the axis).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Literal

from pydantic import model_validator

from ....case.tables.geometry import keyed
from ....case.values.units import Coordinate, Length
from ...meshing.cells import Sheet
from ...meshing.rings import Division
from .arc_contact import ArcContact
from .shoe import ORIGIN, Shoe, layered_sheets

_STEEPEST = math.radians(85.0)


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
        return layered_sheets(division, self.radius, self.arc, self.layers)

    def on_holder(self):
        return ORIGIN.circle(self.held_radius)


class RingSegmentOnDisk(InsideRing):
    """Dimensions of a ring segment and a ring-shaped disk; the segment is pressed upwards.

    Attributes
    ----------
    disk_radius : float
        Inner radius of the disk, where both bodies touch [m].
    disk_outer_radius : float
        Outer radius of the disk, where it is fixed [m].
    segment_thickness : float
        Radial thickness of the segment [m].
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
    drum_radius : float
        Inner radius of the drum, where the lining touches [m].
    drum_thickness : float
        Radial thickness of the drum [m].
    lining_thickness : float
        Radial thickness of the lining [m].
    shoe_thickness : float
        Radial thickness of the shoe [m].
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
        self.shoe.check()
        return self

    @property
    def shoe(self) -> Shoe:
        return Shoe(self.drum_radius, self.arc, self.layers, self.pivot)

    @keyed
    def pivot_point(self) -> tuple[float, float]:
        return self.pivot

    @keyed
    def press_direction(self) -> tuple[float, float]:
        """Outward direction at the middle of the lining."""
        return self.shoe.outward

    @property
    def far_radius(self) -> float:
        return self.drum_radius + self.drum_thickness

    @property
    def layers(self) -> tuple[float, float]:
        return self.lining_thickness, self.shoe_thickness

    def upper_sheets(self, division: Division) -> list[Sheet]:
        return self.shoe.sheets(division, "lining")
