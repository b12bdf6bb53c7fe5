"""Tube resting in the larger hole of a support (section across the tube).

They touch at the origin, at the bottom of both; the tube is pressed down.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from pydantic import model_validator

from ....case.tables.geometry import Pressing, named
from ....case.tables.plane_geometry import PlaneGeometry
from ....case.values.units import Length
from ....errors import CaseError
from ...meshing.cells import ORDER, mesh_body, tagged_bodies
from ...meshing.polar import Polar, incomplete
from ..on_block import expected_half_width

_THINNEST = 1e-6
"""Least contact width relative to the tube's radius."""

_EXPECTED, _LARGEST, _FACE = map(math.radians, (60.0, 75.0, 80.0))
"""Largest angles from the bottom: of an expected contact, of a meshable contact, of a face."""


class TubeInSupport(PlaneGeometry):
    """Dimensions of tube and support.

    Attributes
    ----------
    tube_radius, tube_wall : float
        Outer radius and wall thickness of the tube [m].
    support_clearance : float
        Radial clearance: radius of the hole minus that of the tube [m].
    support_thickness : float
        Thickness of the support around its hole [m].
    zone : float or None
        Half-width of the contact zone to be meshed, by default the expected one of the unworn
        bodies; larger for contacts that move, or grow by wear [m].
    """

    name = "tube-in-support"
    models = ("plane-strain", "plane-stress")
    bodies = ("tube", "support")
    surfaces = (*named("tube", "face", "outside", "bore"), *named("support", "face", "hole", "rim"))
    held = "tube_bore"
    fixed = "support_rim"

    type: Literal["tube-in-support"]
    tube_radius: Length
    tube_wall: Length
    support_clearance: Length
    support_thickness: Length
    zone: Length | None = None

    @model_validator(mode="after")
    def _fits(self):
        self.check_less("tube_wall", "tube_radius")
        return self

    @property
    def hole_radius(self) -> float:
        return self.tube_radius + self.support_clearance

    def expected_zone(self, pressing: Pressing) -> tuple[float, float]:
        """Hertzian half-width as an arc of the tube; conforming contacts are shorter."""
        if self.zone is not None:
            return -self.zone, self.zone
        radius = self.tube_radius * self.hole_radius / self.support_clearance
        a = expected_half_width(pressing, radius, self.thickness)
        x = self.tube_radius * math.sin(min(a / self.tube_radius, _EXPECTED))
        return -x, x

    def check_zone(self, zone):
        self._angles(zone)

    def build(self, mesh, zone):
        radius, hole = self.tube_radius, self.hole_radius
        angles = self._angles(zone)
        tube_face, hole_face = (
            incomplete(angles, radius, mesh.face(body), _FACE) for body in self.bodies
        )
        hole_face = replace(hole_face, angles=self._opposite(hole_face.angles))
        tube, support = Polar(radius, downwards=True), Polar(hole, downwards=True)
        bore, rim = radius - self.tube_wall, hole + self.support_thickness
        bodies = {
            "tube": [tube.sheet(tube_face.all_round(), tube_face.rows(radius, bore))],
            "support": [support.sheet(hole_face.all_round(), hole_face.rows(hole, rim))],
        }
        claims = {
            "tube_face": tube.circle(radius, tube_face.span),
            "tube_outside": tube.circle(radius),
            "tube_bore": tube.circle(bore),
            "support_face": support.circle(hole, hole_face.span),
            "support_hole": support.circle(hole),
            "support_rim": support.circle(rim),
        }
        return tagged_bodies({name: mesh_body(s, ORDER) for name, s in bodies.items()}, claims)

    def _angles(self, zone: tuple[float, float]) -> tuple[float, float]:
        """Contact zone as angles of the tube."""
        outer, limit = max(map(abs, zone)), self.tube_radius * math.sin(_LARGEST)
        if not zone[1] - zone[0] > _THINNEST * self.tube_radius:
            raise CaseError(
                f"geometry: the contact zone from x = {zone[0]:.3g} to {zone[1]:.3g} m is empty"
            )
        if not outer <= limit:
            raise CaseError(
                f"geometry.{'support_clearance' if self.zone is None else 'zone'}: too "
                f"{'small' if self.zone is None else 'large'} for the contact, which is expected "
                f"up to x = {outer:.3g} m; it can be meshed up to {limit:.3g} m"
            )
        first, last = (math.asin(x / self.tube_radius) for x in zone)
        return first, last

    def _opposite(self, angles: np.ndarray) -> np.ndarray:
        """Angles about the centre of the hole at the intersections with the tube's normals."""
        apart, across, up = self.support_clearance, np.sin(angles), np.cos(angles)
        length = np.sqrt(self.hole_radius**2 - (apart * across) ** 2) - apart * up
        return np.arctan2(length * across, apart + length * up)
