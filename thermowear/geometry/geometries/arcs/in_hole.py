"""Ring inside a slightly larger round hole: their cells, and geometries of two such bodies.

Angles are measured from the middle of the contact.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ....case.tables.geometry import keyed
from ....case.tables.plane_geometry import PlaneGeometry
from ....case.values.pressing import Pressing
from ....case.values.section import KeyFault
from ....case.values.units import Length
from ....errors import CaseError
from ...meshing.cells import ORDER, Claim, every, mesh_body, tagged_bodies
from ...meshing.rings import Division, Polar, incomplete
from ..on_block import expected_half_width
from .shoe import degrees

_THINNEST = 1e-6
"""Least contact width relative to the inner ring's radius."""

_EXPECTED, _LARGEST, _FACE = map(math.radians, (60.0, 75.0, 80.0))
"""Largest angles from the middle: of an expected contact, of a meshable contact, of a face."""

_ARCS = math.radians(5.0), math.radians(300.0)
"""Smallest and largest angle of a sector of the outer ring."""

_OF_ARC = 0.8
"""Largest angle of the face of an arc of a hole, over half the arc: it is exceeded by a quarter."""

Span = tuple[float, float] | None


def check_arc(key: str, arc: float | None) -> None:
    """Reject the arc of a hole that holds no face, or goes round the ring."""
    if arc is not None and not _ARCS[0] <= arc <= _ARCS[1]:
        raise KeyFault(
            key, f"{degrees(arc)} must be from {degrees(_ARCS[0])} to {degrees(_ARCS[1])}"
        )


@dataclass(frozen=True)
class InHole:
    """Ring inside a hole of another one, or of a sector of it, touching at one point.

    Attributes
    ----------
    radius, wall : float
        Outer radius and thickness of the inner ring [m].
    clearance : float
        Radius of the hole minus that of the inner ring [m].
    thickness : float
        Thickness of the outer ring around its hole [m].
    arc : float or None
        Angle of the sector of the outer ring; None: all of it [rad].
    """

    radius: float
    wall: float
    clearance: float
    thickness: float
    arc: float | None = None

    @property
    def hole(self) -> float:
        return self.radius + self.clearance

    @property
    def bore(self) -> float:
        return self.radius - self.wall

    @property
    def rim(self) -> float:
        return self.hole + self.thickness

    @property
    def limit(self) -> float:
        """Largest angle of a face."""
        return _FACE if self.arc is None else min(_FACE, _OF_ARC * self.arc / 2)

    @property
    def farthest(self) -> float:
        """Largest distance of the contact from the line through the middle that can be meshed."""
        return self.radius * math.sin(self.limit * _LARGEST / _FACE)

    def expected_reach(self, pressing: Pressing, length: float) -> float:
        """Hertzian half-width as an arc of the inner ring; conforming contacts are shorter."""
        a = expected_half_width(pressing, self.radius * self.hole / self.clearance, length)
        return self.radius * math.sin(min(a / self.radius, _EXPECTED))

    def angles(self, zone: tuple[float, float]) -> tuple[float, float]:
        """Angles about the centre of the inner ring of the ends of a contact zone."""
        first, last = (math.asin(x / self.radius) for x in zone)
        return first, last

    def faces(
        self, zone: tuple[float, float], inner: tuple[int, float], outer: tuple[int, float]
    ) -> tuple[Division, Division]:
        """Divisions of both faces, opposite to each other, each about its own centre.

        Parameters
        ----------
        zone : tuple of float
            Contact zone along the tangent at the middle [m].
        inner, outer : tuple of int and float
            Number of elements and grading, see `thermowear.case.tables.schema.Mesh.face`.
        """
        ring, hole = (
            incomplete(self.angles(zone), self.radius, face, self.limit) for face in (inner, outer)
        )
        return ring, replace(hole, angles=self._opposite(hole.angles))

    def around(self, face: Division) -> np.ndarray:
        """Angles of the element ends around the hole, or on its arc."""
        return face.all_round() if self.arc is None else face.sector(self.arc / 2)

    def _opposite(self, angles: np.ndarray) -> np.ndarray:
        """Angles about the centre of the hole at the intersections with the ring's normals."""
        apart, across, up = self.clearance, np.sin(angles), np.cos(angles)
        length = np.sqrt(self.hole**2 - (apart * across) ** 2) - apart * up
        return np.arctan2(length * across, apart + length * up)


class InHoleGeometry(PlaneGeometry):
    """Base class of two such bodies: they touch at the origin, at the bottom of both.

    Attributes
    ----------
    zone : float or None
        Half-width of the contact zone to be meshed, by default the expected one of the unworn
        bodies; larger for contacts that move, or grow by wear [m].
    inner, outer : str
        Names of the body inside the hole, and of that with the hole.
    clearance_key : str
        Key of the radial clearance.
    """

    models = ("plane-strain", "plane-stress")
    inner: ClassVar[str]
    outer: ClassVar[str]
    clearance_key: ClassVar[str]

    zone: Length | None = None

    @property
    @abstractmethod
    def drawing(self) -> InHole: ...

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        return tuple(self._claims())

    def bearing_area(self) -> float:
        return 2 * self.drawing.radius * self.thickness

    def expected_zone(self, pressing: Pressing) -> tuple[float, float]:
        reach = self.zone or self.drawing.expected_reach(pressing, self.thickness)
        return -reach, reach

    def check_zone(self, zone):
        radius, limit = self.drawing.radius, self.drawing.farthest
        if not zone[1] - zone[0] > _THINNEST * radius:
            raise CaseError(
                f"geometry: the contact zone from x = {zone[0]:.3g} to {zone[1]:.3g} m is empty"
            )
        outermost = max(map(abs, zone))
        if not outermost <= limit:
            raise CaseError(
                f"geometry.{self.clearance_key if self.zone is None else 'zone'}: too "
                f"{'small' if self.zone is None else 'large'} for the contact, which is expected "
                f"up to x = {outermost:.3g} m; it can be meshed up to {limit:.3g} m"
            )

    def build(self, mesh, zone):
        self.check_zone(zone)
        drawing = self.drawing
        face, hole_face = drawing.faces(zone, mesh.face(self.inner), mesh.face(self.outer))
        ring, holed = self._centres
        rows = face.rows(drawing.radius, drawing.bore)
        hole_rows = hole_face.rows(drawing.hole, drawing.rim)
        sheets = {
            self.inner: ring.sheet(face.all_round(), rows),
            self.outer: holed.sheet(drawing.around(hole_face), hole_rows),
        }
        bodies = {name: mesh_body([sheets[name]], ORDER) for name in self.bodies}
        return tagged_bodies(bodies, self._claims(face.span, hole_face.span))

    @property
    def _centres(self) -> tuple[Polar, Polar]:
        radius, hole = self.drawing.radius, self.drawing.hole
        return Polar(radius, downwards=True), Polar(hole, downwards=True)

    def _claims(self, face: Span = None, hole_face: Span = None) -> dict[str, Claim]:
        """Predicates of all surfaces for the angles at the ends of both faces."""
        drawing, (ring, holed) = self.drawing, self._centres
        claims = {
            f"{self.inner}_face": ring.circle(drawing.radius, face),
            f"{self.inner}_outside": ring.circle(drawing.radius),
            f"{self.inner}_bore": ring.circle(drawing.bore),
            f"{self.outer}_face": holed.circle(drawing.hole, hole_face),
            f"{self.outer}_hole": holed.circle(drawing.hole),
            f"{self.outer}_rim": holed.circle(drawing.rim),
        }
        return claims if drawing.arc is None else claims | {f"{self.outer}_side": every}
