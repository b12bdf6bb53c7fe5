"""Tube resting in the larger hole of a support (section across the tube).

They touch at the origin, at the bottom of both; the tube is pressed down.
"""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from ....case.values.units import Angle, Length
from .in_hole import InHole, InHoleGeometry, check_arc


class TubeInSupport(InHoleGeometry):
    """Dimensions of tube and support.

    Attributes
    ----------
    tube_radius : float
        Outer radius of the tube [m].
    tube_wall : float
        Wall thickness of the tube [m].
    support_clearance : float
        Radial clearance: radius of the hole minus that of the tube [m].
    support_thickness : float
        Thickness of the support around its hole [m].
    support_arc : float or None
        Angle that the support covers, with the contact in the middle; by default all of the tube
        [rad].
    """

    name = "tube-in-support"
    bodies = ("tube", "support")
    inner, outer = bodies
    held = "tube_bore"
    fixed = "support_rim"
    clearance_key = "support_clearance"

    type: Literal["tube-in-support"]
    tube_radius: Length
    tube_wall: Length
    support_clearance: Length
    support_thickness: Length
    support_arc: Angle | None = None

    @model_validator(mode="after")
    def _fits(self):
        self.check_less("tube_wall", "tube_radius")
        check_arc("support_arc", self.support_arc)
        return self

    @property
    def drawing(self) -> InHole:
        return InHole(
            self.tube_radius,
            self.tube_wall,
            self.support_clearance,
            self.support_thickness,
            self.support_arc,
        )
