"""Round pin on a rotating disk, in space.

The contact lies at z = 0; the pin is above, on the x-axis. Both bodies consist of curved tetrahedra
made by gmsh.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Literal

import numpy as np
from pydantic import model_validator

from ...case.tables.geometry import Geometry, keyed, named
from ...case.values.pressing import Pressing
from ...case.values.section import KeyFault
from ...case.values.units import Length
from ...errors import CaseError
from ..mesh.tagged import TaggedMesh
from ..meshing.cells import MeshedBody, tagged_bodies
from ..meshing.tetrahedra import RoundZone, mesh_solids
from .pin_drawing import DrawnPin

_ORDER = 2
"""Largest cell order; never above the displacement degree, so that rigid rotations are exact."""
_STEEPEST = 0.5
"""Radius of the face of a spherical end over the radius of the sphere."""
_CLEARANCE = 0.05
"""Least distance of the pin from the edges of the disk, by the radius of the pin."""
_FACE = 1.4
"""Radius of the contact faces of a spherical end over that of the expected contact."""
_THINNEST = 1e-4
"""Least contact radius that can be meshed, over the largest."""


class PinOnDisk(Geometry):
    """Dimensions of pin and disk, which rotates about the z-axis.

    ``mesh.elements`` is the number across the contact: a flat end, or the expected contact of a
    spherical one. Elements at its edge are smaller by the factor ``mesh.grading``.

    Attributes
    ----------
    pin_radius : float
        Radius of the pin [m].
    pin_height : float
        Height of the pin [m].
    end : str
        ``"flat"`` or ``"spherical"``.
    end_radius : float or None
        Radius of a spherical end, at least that of the pin [m].
    zone : float or None
        Radius of the finely meshed zone of a spherical end, by default that of the expected contact
        of the unworn bodies; larger for contacts that grow by wear [m].
    track_radius : float
        Distance of the axis of the pin from that of the disk [m].
    disk_inner_radius : float
        Inner radius of the disk [m].
    disk_outer_radius : float
        Outer radius of the disk [m].
    disk_thickness : float
        Thickness of the disk [m].
    """

    name = "pin-on-disk"
    models = ("3d",)
    bodies = ("pin", "disk")
    held = "pin_top"
    fixed = "disk_bottom"
    surfaces = (
        *named("pin", "face", "top", "side"),
        *named("disk", "face", "rest", "bottom", "inside", "outside"),
    )
    press_direction = (0.0, 0.0, -1.0)
    rotation_center = (0.0, 0.0)
    unmeshed = ("zone",)
    along_paths = False

    type: Literal["pin-on-disk"]
    pin_radius: Length
    pin_height: Length
    end: Literal["flat", "spherical"] = "flat"
    end_radius: Length | None = None
    zone: Length | None = None
    track_radius: Length
    disk_inner_radius: Length
    disk_outer_radius: Length
    disk_thickness: Length

    @model_validator(mode="after")
    def _end(self):
        if self.end == "flat":
            for key in ("end_radius", "zone"):
                if getattr(self, key) is not None:
                    raise KeyFault(key, 'requires end = "spherical"')
        elif self.end_radius is None:
            raise KeyFault("end_radius", 'missing; required by end = "spherical"')
        elif self.end_radius < self.pin_radius * (1 - 1e-9):
            raise KeyFault(
                "end_radius",
                f"{self.end_radius:g} m must be at least pin_radius {self.pin_radius:g} m",
            )
        if not self.pin_height > 1.05 * self.end_height:
            raise KeyFault(
                "pin_height",
                f"{self.pin_height:g} m must be greater than 1.05 times the height of the "
                f"spherical end {self.end_height:.4g} m",
            )
        return self

    @model_validator(mode="after")
    def _on_disk(self):
        reach = (1 + _CLEARANCE) * self.pin_radius
        inner, outer = self.disk_inner_radius, self.disk_outer_radius
        if not inner + reach <= self.track_radius <= outer - reach:
            raise KeyFault(
                "track_radius",
                f"{self.track_radius:g} m must be between {inner + reach:.6g} m and "
                f"{outer - reach:.6g} m: the pin must be on the disk, with a margin of "
                f"{_CLEARANCE:g} pin_radius",
            )
        return self

    @property
    def end_height(self) -> float:
        """Height of the end of the pin, 0 for a flat one [m]."""
        if self.end_radius is None:
            return 0.0
        radius = max(self.end_radius, self.pin_radius)
        return radius - math.sqrt(radius**2 - self.pin_radius**2)

    @property
    def widest_face(self) -> float:
        """Largest radius of the contact faces [m]."""
        if self.end_radius is None:
            return self.pin_radius
        return min(self.pin_radius, _STEEPEST * self.end_radius)

    def sphere(self, away: np.ndarray) -> np.ndarray:
        """Height of the spherical end at distances from its axis [m]."""
        assert self.end_radius is not None
        return away**2 / (self.end_radius + np.sqrt(self.end_radius**2 - away**2))

    @keyed
    def pivot_point(self) -> tuple[float, ...]:
        """Middle of the pin's end."""
        return (self.track_radius, 0.0, 0.0)

    @property
    def follows_contact(self) -> bool:
        """False: the mesh is refined for the expected contact, but never fitted to its edge."""
        return False

    @keyed
    def footprint(self) -> tuple[float, float | None]:
        return self.track_radius, self.pin_radius if self.end_radius is None else None

    def contact_area(self) -> float | None:
        return math.pi * self.pin_radius**2 if self.end == "flat" else None

    def expected_zone(self, pressing: Pressing) -> tuple[float, float] | None:
        if self.end_radius is None:
            return None
        if pressing.force is not None:  # Hertz
            found = (3 * pressing.force * self.end_radius / (4 * pressing.modulus)) ** (1 / 3)
        else:
            assert pressing.approach is not None
            found = math.sqrt(self.end_radius * pressing.approach)
        if self.zone is not None and self.zone < found:
            raise CaseError(
                f"geometry.zone: found {self.zone:g} m; must be at least the expected "
                f"radius of the unworn contact, {found:.3g} m"
            )
        radius = found if self.zone is None else self.zone
        return self.track_radius - radius, self.track_radius + radius

    def check_zone(self, zone: tuple[float, float]) -> None:
        radius = (zone[1] - zone[0]) / 2
        widest = self.widest_face / _FACE
        if not _THINNEST * widest <= radius <= widest:
            raise CaseError(
                f"geometry.end_radius: the contact is expected to have a radius of {radius:.3g} m; "
                f"it can be meshed from {_THINNEST * widest:.3g} m to {widest:.3g} m"
            )

    def build(self, mesh, zone=None) -> TaggedMesh:
        radius = face = self.pin_radius
        if zone is not None:
            self.check_zone(zone)
            radius = (zone[1] - zone[0]) / 2
            face = _FACE * radius
        drawn = DrawnPin(self, face)
        zones = {"pin": self._zone("pin", mesh, radius), "disk": self._zone("disk", mesh, radius)}
        order = min(mesh.degree, _ORDER)
        alike = mesh.face("pin") == mesh.face("disk")
        groups = [zones] if alike else [{name: zone} for name, zone in zones.items()]
        bodies: dict[str, MeshedBody] = {}
        for group in groups:
            bodies |= mesh_solids(partial(drawn.draw, tuple(group)), group, order, drawn.unit)
        bodies["pin"] = replace(bodies["pin"], points=drawn.rounded(bodies["pin"].points))
        return replace(tagged_bodies(bodies, drawn.claims()), cell_type="tetrahedron")

    def _zone(self, body: str, mesh, radius: float) -> RoundZone:
        """Element sizes of a body for a contact radius [m]."""
        elements, grading = mesh.face(body)
        inner, outer = self.disk_inner_radius, self.disk_outer_radius
        largest, volume = self.pin_radius, math.pi * self.pin_radius**2 * self.pin_height
        if body == "disk":
            largest = min(max(1.5 * self.disk_thickness, self.pin_radius), 0.5 * (outer - inner))
            volume = math.pi * (outer**2 - inner**2) * self.disk_thickness
        inside = 2 * radius / elements
        sizes = inside, grading * inside, max(largest, inside)
        return RoundZone(self.track_radius, radius, *sizes, volume)
