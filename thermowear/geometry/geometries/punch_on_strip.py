"""Flat punch with sharp edges on a strip that moves along x, or reciprocating on a strip at rest.

The contact lies at y = 0 and is centred at x = 0.
"""

from __future__ import annotations

import math
from typing import Literal

from pydantic import model_validator

from ...case.values.units import Distance, Length
from ..meshing.blocks import Interval
from .on_strip import OnStrip
from .stacked import Rectangle


class PunchOnStrip(OnStrip):
    """Dimensions of punch and strip.

    Attributes
    ----------
    width, height : float
        Dimensions of the punch [m].
    stroke : float
        Amplitude of a reciprocating punch on a strip at rest: the strip is meshed for contact over
        the whole stroke [m].
    """

    name = "punch-on-strip"
    bodies = ("punch", "strip")

    type: Literal["punch-on-strip"]
    width: Length
    height: Length
    stroke: Distance = 0.0

    @model_validator(mode="after")
    def _fits(self):
        self.check_strip()
        return self

    @property
    def upper(self) -> Rectangle:
        return Rectangle(-self.width / 2, self.width / 2, self.height)

    @property
    def lower_face(self) -> tuple[float, float]:
        reach = self.width / 2 + self.stroke
        return -reach, reach

    def _lower_face(self, elements, grading, zone):
        if self.stroke == 0.0:
            return super()._lower_face(elements, grading, zone)
        start, end = self.lower_face  # the contact edges move over the face: uniform elements
        return [Interval(start, end, math.ceil(elements * (end - start) / self.width - 1e-9))]
