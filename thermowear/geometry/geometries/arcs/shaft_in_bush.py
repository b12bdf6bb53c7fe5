"""Shaft turning in a bush with clearance (section across the axis).

They touch at the origin, at the bottom of both. The shaft is fixed and turns about its own centre;
the bush is pressed upwards on it.
"""

from __future__ import annotations

import math
from typing import Literal

from pydantic import model_validator

from ....case.tables.geometry import keyed
from ....case.values.units import Length
from .in_hole import InHole, InHoleGeometry


class ShaftInBush(InHoleGeometry):
    """Dimensions of shaft and bush.

    Attributes
    ----------
    shaft_radius : float
        Radius of the shaft [m].
    shaft_depth : float
        Thickness of the elastic ring of the shaft around its rigid core [m].
    bush_clearance : float
        Radial clearance: radius of the bush's hole minus that of the shaft [m].
    bush_thickness : float
        Radial thickness of the bush [m].
    """

    name = "shaft-in-bush"
    bodies = ("bush", "shaft")
    outer, inner = bodies
    held = "bush_rim"
    fixed = "shaft_bore"
    press_direction = (0.0, 1.0)
    clearance_key = "bush_clearance"

    type: Literal["shaft-in-bush"]
    shaft_radius: Length
    shaft_depth: Length
    bush_clearance: Length
    bush_thickness: Length

    @model_validator(mode="after")
    def _fits(self):
        self.check_less("shaft_depth", "shaft_radius")
        return self

    @property
    def drawing(self) -> InHole:
        return InHole(self.shaft_radius, self.shaft_depth, self.bush_clearance, self.bush_thickness)

    @keyed
    def rotation_center(self) -> tuple[float, float]:
        return 0.0, self.shaft_radius

    @keyed
    def pivot_point(self) -> tuple[float, float]:
        return self.rotation_center

    @keyed
    def track(self) -> float:
        return 2 * math.pi * self.shaft_radius
