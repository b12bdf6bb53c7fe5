"""Base of geometries whose body 1 conforms to a circle of a rotating body 2; block on a disk.

Body 2 is a whole ring (a disk with a bore, a drum) about the origin. Angles are measured from
12 o'clock (the direction +y), clockwise: positive towards +x.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import ClassVar, Literal

import numpy as np
from pydantic import model_validator

from ....case.tables.geometry import keyed
from ....case.tables.plane_geometry import PlaneGeometry
from ....case.values.section import KeyFault
from ....case.values.units import Angle, Length
from ...meshing.cells import ORDER, Claim, Sheet, every, grid, level, mesh_body, tagged_bodies
from ...meshing.rings import Division, complete
from .shoe import ORIGIN, check_order, degrees

_STEEPEST = math.radians(80.0)
"""Largest angle of the arc of a block: at least 10 degrees with its vertical side."""


class ArcContact(PlaneGeometry):
    """Base class: the whole face of body 1, an arc, is in contact.

    Attributes
    ----------
    arc_start : float
        Angle at the first edge of the contact, clockwise from 12 o'clock (+y) [rad].
    arc_end : float
        Angle at its other edge, greater than that at the first one [rad].
    rest : str
        Surface of body 2 that is the rest of its contact circle.
    circle, far_circle : str
        Keys of the radii of the contact circle and of the circle where body 2 is fixed.
    """

    models = ("plane-strain", "plane-stress")
    rotation_center = (0.0, 0.0)
    rest: ClassVar[str]
    circle: ClassVar[str] = "disk_radius"
    far_circle: ClassVar[str]

    arc_start: Angle
    arc_end: Angle

    @model_validator(mode="after")
    def _ordered(self):
        check_order(self.arc)
        return self

    def check_arc(self, limit: float) -> None:
        """Reject arcs beyond an angle from 12 o'clock (+y) on either side."""
        for key, angle in (("arc_start", self.arc_start), ("arc_end", self.arc_end)):
            if abs(angle) > limit:
                raise KeyFault(
                    key,
                    f"{degrees(angle)} must be within {degrees(limit)} of 12 o'clock (+y), on "
                    "either side",
                )

    @property
    def radius(self) -> float:
        """Radius of the contact circle [m]."""
        return getattr(self, self.circle)

    @property
    def far_radius(self) -> float:
        """Radius of the circle where body 2 is fixed [m]."""
        return getattr(self, self.far_circle)

    @abstractmethod
    def upper_sheets(self, division: Division) -> list[Sheet]:
        """Cells of body 1."""

    @abstractmethod
    def on_holder(self) -> Claim:
        """Predicate of the edges of body 1 on the holder."""

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        return tuple(self._claims())

    @property
    def arc(self) -> tuple[float, float]:
        return self.arc_start, self.arc_end

    @keyed
    def track(self) -> float:
        return 2 * math.pi * self.radius

    @property
    def follows_contact(self) -> bool:
        """True if x is unique along the arc, so that thermal separation can be resolved."""
        return max(map(abs, self.arc)) < math.pi / 2

    def contact_area(self) -> float:
        """Projected area of the arc: resultant of a unit pressure along the load direction [m²]."""
        x, y = self.press_direction
        start, end = self.arc
        across = x * (math.cos(start) - math.cos(end)) + y * (math.sin(end) - math.sin(start))
        return abs(across) * self.radius * self.thickness

    def build(self, mesh, zone=None):
        upper, ring = self.bodies
        angles = None
        if zone is not None:
            first, last = (math.asin(min(max(x / self.radius, -1.0), 1.0)) for x in zone)
            angles = first, last
        divisions = [
            complete(self.arc, self.radius, mesh.face(body), angles) for body in self.bodies
        ]
        around = divisions[1].all_round(), divisions[1].rows(self.radius, self.far_radius)
        bodies = {
            upper: mesh_body(self.upper_sheets(divisions[0]), ORDER),
            ring: mesh_body([ORIGIN.sheet(*around)], ORDER),
        }
        return tagged_bodies(bodies, self._claims())

    def _claims(self) -> dict[str, Claim]:
        """Predicates of all surfaces, see `tagged_bodies`."""
        upper_face, ring_face = self.contact
        return {
            upper_face: ORIGIN.circle(self.radius),
            self.held: self.on_holder(),
            f"{self.bodies[0]}_side": every,
            ring_face: ORIGIN.circle(self.radius, self.arc),
            self.rest: ORIGIN.circle(self.radius),
            self.fixed: ORIGIN.circle(self.far_radius),
        }


class BlockOnDisk(ArcContact):
    """Dimensions of a block with a concave face on the rim of a disk; its flat top is held.

    Attributes
    ----------
    disk_radius : float
        Radius of the rim of the disk [m].
    disk_bore : float
        Radius of the bore of the disk, where it is fixed [m].
    block_height : float
        Height of the block's top above the highest point of the disk [m].
    """

    name = "block-on-disk"
    bodies = ("block", "disk")
    held = "block_top"
    fixed = "disk_bore"
    rest = "disk_rim"
    far_circle = "disk_bore"

    type: Literal["block-on-disk"]
    disk_radius: Length
    disk_bore: Length
    block_height: Length

    @model_validator(mode="after")
    def _fits(self):
        self.check_arc(_STEEPEST)
        self.check_less("disk_bore", "disk_radius")
        return self

    @property
    def top(self) -> float:
        """Height of the block's top above the centre of the disk [m]."""
        return self.disk_radius + self.block_height

    def upper_sheets(self, division: Division) -> list[Sheet]:
        radius, top = self.disk_radius, self.top
        highest_side = top - radius * min(map(math.cos, self.arc))
        width = radius * float(np.ptp(np.sin(self.arc)))
        rows = division.layered((highest_side,), width)[0] / highest_side

        def place(p):
            angle, up = p[..., 0], p[..., 1]
            y = (1 - up) * radius * np.cos(angle) + up * top
            return np.stack([radius * np.sin(angle), y], axis=-1)

        return [Sheet(grid(division.angles, rows), place)]

    def on_holder(self):
        return level(1, self.top)
