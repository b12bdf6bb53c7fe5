"""Base of geometries whose body 1 is a ring sector pressed outwards on body 2."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from ..meshing.polar import Division
from ..meshing.quads import Sheet
from .arc_contact import ORIGIN, ArcContact


class InsideRing(ArcContact):
    """Base class: body 1 is held on its inner arc."""

    name: ClassVar[str] = ""

    @property
    def layers(self) -> tuple[float, ...]:
        """Radial thicknesses of body 1, from its face inwards [m]."""
        raise NotImplementedError

    @property
    def held_radius(self) -> float:
        return self.radius - sum(self.layers)

    def upper_sheets(self, division: Division) -> list[Sheet]:
        length = self.radius * float(np.ptp(self.arc))
        layers = division.layered(self.layers, length)
        return [ORIGIN.sheet(division.angles, self.radius - depths) for depths in layers]

    def on_holder(self, p):
        return ORIGIN.on_circle(p, self.held_radius)
