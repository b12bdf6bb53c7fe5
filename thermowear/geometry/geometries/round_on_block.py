"""Cylinder or sphere on a block: a circular section touching a rectangle.

They touch at the origin. The lower half of the disc above is meshed (or the right half of that);
it is held on the flat at the height of its centre.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Literal

import numpy as np

from ...case.tables.geometry import Pressing
from ...case.values.units import Length
from ...errors import CaseError
from ..meshing.cells import ORDER, between, both, level, mesh_body
from ..meshing.divisions import face_ends, growth, row_ratio
from ..meshing.polar import Polar
from ..meshing.rings import Disc, ringed_body
from .on_block import OnBlock, PlaneOnBlock, expected_half_width


class RoundOnBlock(OnBlock):
    """Base class: body 1 has a circular section.

    Attributes
    ----------
    radius : float [m]
    zone : float or None
        Half-width (radius) of the contact zone to be meshed, by default the expected one of the
        unworn bodies; larger for contacts that grow by wear [m].
    """

    radius: Length
    zone: Length | None = None

    @abstractmethod
    def unworn_half_width(self, pressing: Pressing) -> float:
        """Estimate of the half-width (radius) of the unworn contact [m]."""

    def expected_zone(self, pressing):
        expected = self.unworn_half_width(pressing)
        if self.zone is None:
            return -expected, expected
        if self.zone < expected:
            raise CaseError(
                f"geometry.zone: found {self.zone:g} m; must be at least the expected "
                f"half-width of the unworn contact, {expected:.3g} m"
            )
        return -self.zone, self.zone

    def upper_limits(self):
        return {"radius": self.radius / 2}

    def upper_body(self, mesh, zone):
        radius = self.radius
        elements, grading = mesh.face(self.bodies[0])
        limits = (-0.65 * radius, 0.65 * radius)
        ends, largest = face_ends(zone, elements, grading, self.right_only, limits)
        along = radius * np.arcsin(ends / radius)
        rows = largest, row_ratio(elements)
        sheets = ringed_body(Disc(radius, self.right_only), along, rows, growth(elements))

        on_arc = Polar(radius).circle(radius)
        claims = {
            "face": both(on_arc, between(ends[0], ends[-1])),
            "side": on_arc,
            "top": level(1, radius),
        }
        return mesh_body(sheets, ORDER), claims


class CylinderOnBlock(RoundOnBlock, PlaneOnBlock):
    """Dimensions of a cylinder pressed on a block, or sliding along it, see the bases."""

    name = "cylinder-on-block"
    bodies = ("cylinder", "block")

    type: Literal["cylinder-on-block"]

    def unworn_half_width(self, pressing: Pressing) -> float:
        return expected_half_width(pressing, self.radius, self.thickness)


class SphereOnBlock(RoundOnBlock):
    """Dimensions of a sphere pressed on a cylindrical block, or rotating on it (r and z).

    Attributes
    ----------
    block_radius : float [m]
    """

    name = "sphere-on-block"
    models = ("axisymmetric",)
    bodies = ("sphere", "block")
    block_key = "block_radius"
    slides_across = True

    type: Literal["sphere-on-block"]
    block_radius: Length

    @property
    def block_reach(self) -> float:
        return self.block_radius

    def unworn_half_width(self, pressing: Pressing) -> float:
        if pressing.force is not None:  # Hertz
            return (3 * pressing.force * self.radius / (4 * pressing.modulus)) ** (1 / 3)
        assert pressing.approach is not None
        return math.sqrt(self.radius * pressing.approach)
