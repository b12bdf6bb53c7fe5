"""Flat punch, and block on a pivot, sliding on a strip that moves along x, or reciprocating on it.

The contact lies at y = 0, in the middle of the strip.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from pydantic import model_validator

from ...case.tables.geometry import keyed, named
from ...case.tables.plane_geometry import PlaneGeometry
from ...case.values.section import KeyFault
from ...case.values.units import Distance, Length
from ..meshing.divisions import growth
from .stacked import Rectangle, Stacked


class OnStrip(Stacked, PlaneGeometry):
    """Base class: body 1 is a rectangle with sharp edges, body 2 the ``strip``.

    Left and right sides are separate surfaces, as the strip enters on one side.

    Attributes
    ----------
    strip_length : float
        Length of the strip, at least that of the face of body 1 [m].
    strip_height : float
        Height of the strip [m].
    """

    models = ("plane-strain", "plane-stress")
    fixed = "strip_bottom"

    strip_length: Length
    strip_height: Length

    @keyed
    def held(self) -> str:
        return f"{self.bodies[0]}_top"

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        upper = named(self.bodies[0], "face", "top", "left", "right")
        rest = () if self.covers else ("strip_top",)
        return *upper, *named("strip", "face", "bottom", "right", "left"), *rest

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
        return (self.upper.right - self.upper.left) * self.thickness

    def check_strip(self) -> None:
        """Raise a `KeyFault` if the face is wider than the strip is long."""
        start, end = self.lower_face
        if not end - start <= self.strip_length and not self.covers:
            raise KeyFault(
                "strip_length",
                f"{self.strip_length:g} m must be at least the width of the face {end - start:g} m",
            )


class PunchOnStrip(OnStrip):
    """Dimensions of a flat punch with sharp edges, centred at x = 0, and of the strip.

    Attributes
    ----------
    width : float
        Width of the punch along the strip [m].
    height : float
        Height of the punch [m].
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
        return np.linspace(start, end, math.ceil(elements * (end - start) / self.width - 1e-9) + 1)


class PivotedBlock(OnStrip):
    """Dimensions of a block that rotates about a pivot beside it, and of the strip.

    The pivot lies at x = 0. The block is attached to it by a rigid arm that holds its whole top.

    Attributes
    ----------
    face_start : float
        X at the left end of the block's face, measured from the pivot [m].
    face_end : float
        X at the right end of the block's face, measured from the pivot [m].
    block_height : float
        Height of the block [m].
    pivot_height : float
        Height of the pivot above the face [m].
    """

    name = "pivoted-block"
    bodies = ("block", "strip")

    type: Literal["pivoted-block"]
    face_start: Length
    face_end: Length
    block_height: Length
    pivot_height: Distance

    @model_validator(mode="after")
    def _fits(self):
        self.check_less("face_start", "face_end")
        self.check_strip()
        return self

    @keyed
    def pivot_point(self) -> tuple[float, float]:
        return 0.0, self.pivot_height

    @property
    def upper(self) -> Rectangle:
        return Rectangle(self.face_start, self.face_end, self.block_height)
