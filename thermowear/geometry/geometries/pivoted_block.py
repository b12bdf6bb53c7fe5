"""Block that rotates about a pivot beside it and slides on a strip that moves along x.

The pivot lies at x = 0, above the contact at y = 0. The block is attached to it by a rigid arm
that holds its whole top.
"""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from ...case.tables.geometry import keyed
from ...case.values.units import Distance, Length
from .on_strip import OnStrip
from .stacked import Rectangle


class PivotedBlock(OnStrip):
    """Dimensions of block and strip.

    Attributes
    ----------
    face_start, face_end : float
        X at the ends of the block's face, measured from the pivot [m].
    block_height : float [m]
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
