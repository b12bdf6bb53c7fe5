"""Base of a cylinder and a sphere on a block: a circular section touching a rectangle.

They touch at the origin. The lower half of the disc above is meshed (or the right half of that);
it is held on the flat at the height of its centre.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from ...case.tables.geometry import Pressing
from ...case.values.units import Length
from ...errors import CaseError
from ..meshing.face_ends import face_ends, growth, row_ratio
from ..meshing.outlines import Disc, ringed_body
from ..meshing.quads import mesh_body
from .on_block import ORDER, OnBlock, near, within


class RoundOnBlock(OnBlock):
    """Base class: body 1 has a circular section.

    Attributes
    ----------
    radius : float [m]
    zone : float or None
        Half-width (radius) of the contact zone to be meshed, by default the expected one of the
        unworn bodies; larger for contacts that grow by wear [m].
    """

    name: ClassVar[str] = ""

    radius: Length
    zone: Length | None = None

    def unworn_half_width(self, pressing: Pressing) -> float:
        """Estimate of the half-width (radius) of the unworn contact [m]."""
        raise NotImplementedError

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

        def on_arc(p):
            return near(np.hypot(p[..., 0], p[..., 1] - radius), radius, radius)

        claims = {
            "face": lambda p: on_arc(p) & within(p, (ends[0], ends[-1])),
            "side": on_arc,
            "top": lambda p: near(p[..., 1], radius, radius),
        }
        return mesh_body(sheets, ORDER), claims
