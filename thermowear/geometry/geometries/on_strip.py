"""Base of geometries whose body 1 slides with a flat face on a strip that moves along x.

The contact lies at y = 0, in the middle of the strip.
"""

from __future__ import annotations

import math
from typing import ClassVar

from ...case.tables.geometry import keyed, named
from ...case.tables.plane_geometry import PlaneGeometry
from ...case.values.section import KeyFault
from ...case.values.units import Length
from ..meshing.blocks import SAME
from ..meshing.face_ends import growth
from .stacked import Rectangle, Stacked


class OnStrip(Stacked, PlaneGeometry):
    """Base class: body 1 is a rectangle with sharp edges, body 2 the ``strip``.

    Left and right sides are separate surfaces, as the strip enters on one side.

    Attributes
    ----------
    strip_length, strip_height : float
        Dimensions of the strip, at least as long as the face of body 1 [m].
    """

    name: ClassVar[str] = ""
    models = ("plane-strain", "plane-stress")

    strip_length: Length
    strip_height: Length

    @keyed
    def held(self) -> str:
        return f"{self.bodies[0]}_top"

    @keyed
    def fixed(self) -> str:
        return "strip_bottom"

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        upper = named(self.bodies[0], "face", "top", "left", "right")
        rest = () if self.covers_strip else ("strip_top",)
        return *upper, *named("strip", "face", "bottom", "right", "left"), *rest

    @property
    def covers_strip(self) -> bool:
        """True if the face is as wide as the strip is long, without a free part of its top."""
        start, end = self.lower_face
        return math.isclose(end - start, self.strip_length, rel_tol=SAME)

    @property
    def face_width(self) -> float:
        return self.upper.right - self.upper.left

    @property
    def lower(self) -> Rectangle:
        middle = (self.upper.left + self.upper.right) / 2
        reach = self.strip_length / 2
        return Rectangle(middle - reach, middle + reach, self.strip_height)

    @keyed
    def track(self) -> float:
        return self.strip_length

    def _beside(self, sizes, elements, grading):
        contact, support, largest = sizes
        # beyond a distance of one strip height the fields vary slowly
        coarse = max(largest, self.strip_height)
        return super()._beside(
            (contact, support, coarse), elements, min(grading, 1 / growth(elements))
        )

    def contact_area(self) -> float:
        return self.face_width * self.thickness

    def check_strip(self) -> None:
        """Raise a `KeyFault` if the face is wider than the strip is long."""
        start, end = self.lower_face
        if not end - start <= self.strip_length and not self.covers_strip:
            raise KeyFault(
                "strip_length",
                f"{self.strip_length:g} m must be at least the width of the face {end - start:g} m",
            )
