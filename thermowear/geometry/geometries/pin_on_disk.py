"""Round pin on a rotating disk, in space.

The contact lies at z = 0; the pin is above, on the x-axis. Both bodies consist of curved tetrahedra
made by gmsh.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from pydantic import model_validator

from ...case.tables.geometry import Geometry, Pressing, keyed, named
from ...case.values.section import KeyFault
from ...case.values.units import Length
from ...errors import CaseError
from ..mesh.tagged import TaggedMesh
from ..meshing.cells import Claim, MeshedBody, both, every, tagged_bodies
from ..meshing.tetrahedra import RoundZone, mesh_solid

_ORDER = 2
"""Largest cell order; never above the displacement degree, so that rigid rotations are exact."""
_STEEPEST = 0.5
"""Radius of the face of a spherical end over the radius of the sphere."""
_CLEARANCE = 0.05
"""Least distance of the pin from the edges of the disk, by the radius of the pin."""
_SAME = 1e-7
"""Tolerance for positions of nodes on a surface, by the radius of the pin."""
_THINNEST = 1e-4
"""Least contact radius that can be meshed, by the radius of the face."""


class PinOnDisk(Geometry):
    """Dimensions of pin and disk, which rotates about the z-axis.

    ``mesh.elements`` is the number across the contact, that of a flat end or of the expected contact
    of a spherical one; those at its edge are smaller by the factor ``mesh.grading``.

    Attributes
    ----------
    pin_radius, pin_height : float [m]
    end : str
        ``"flat"`` or ``"spherical"``.
    end_radius : float or None
        Radius of a spherical end, at least that of the pin [m].
    zone : float or None
        Radius of the finely meshed zone of a spherical end, by default that of the expected contact
        of the unworn bodies; larger for contacts that grow by wear [m].
    track_radius : float
        Distance of the axis of the pin from that of the disk [m].
    disk_inner_radius, disk_outer_radius, disk_thickness : float [m]
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
    def face_height(self) -> float:
        """Height of the edge of the contact face on the pin, 0 for a flat one [m]."""
        return 0.0 if self.end_radius is None else float(self._sphere(np.array(self.face_radius)))

    @property
    def face_radius(self) -> float:
        """Radius of the contact faces [m]."""
        if self.end_radius is None:
            return self.pin_radius
        return min(self.pin_radius, _STEEPEST * self.end_radius)

    @keyed
    def pivot_point(self) -> tuple[float, ...]:
        """Middle of the pin's end."""
        return (self.track_radius, 0.0, 0.0)

    @property
    def follows_contact(self) -> bool:
        """False: the mesh is refined for the expected contact, but never fitted to its edge."""
        return False

    @keyed
    def footprint(self) -> tuple[float, float]:
        return self.track_radius, self.face_radius

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
        if not _THINNEST * self.face_radius <= radius <= 0.9 * self.face_radius:
            raise CaseError(
                f"geometry.end_radius: the contact is expected to have a radius of {radius:.3g} m; "
                f"it can be meshed from {_THINNEST * self.face_radius:.3g} m to "
                f"{0.9 * self.face_radius:.3g} m"
            )

    def build(self, mesh, zone=None) -> TaggedMesh:
        radius = self.pin_radius
        if zone is not None:
            self.check_zone(zone)
            radius = (zone[1] - zone[0]) / 2
        order = min(mesh.degree, _ORDER)
        bodies = {
            "pin": self._pin(order, self._sizes(radius, *mesh.face("pin"), self.pin_radius)),
            "disk": self._disk(order, self._sizes(radius, *mesh.face("disk"), self._coarsest)),
        }
        claims = {f"pin_{part}": claim for part, claim in self._pin_claims().items()}
        claims |= {f"disk_{part}": claim for part, claim in self._disk_claims().items()}
        tagged = tagged_bodies(bodies, {surface: claims[surface] for surface in self.surfaces})
        return TaggedMesh(**(vars(tagged) | {"cell_type": "tetrahedron"}))

    @property
    def _coarsest(self) -> float:
        """Largest element size of the disk [m]."""
        width = self.disk_outer_radius - self.disk_inner_radius
        return min(max(1.5 * self.disk_thickness, self.pin_radius), 0.5 * width)

    def _sizes(self, radius: float, elements: int, grading: float, largest: float) -> RoundZone:
        inside = 2 * radius / elements
        return RoundZone(
            self.track_radius, radius, inside, grading * inside, max(largest, inside)
        )

    def _pin(self, order: int, sizes: RoundZone) -> MeshedBody:
        unit, volume = self.pin_radius, math.pi * self.pin_radius**2 * self.pin_height
        flat = mesh_solid(lambda occ: _draw_pin(occ, self, unit), sizes, volume, order, unit)
        return replace(flat, points=self._rounded(flat.points))

    def _rounded(self, points: np.ndarray) -> np.ndarray:
        """Points of a pin with a spherical end from those with a face that is flat.

        Its nodes are moved down to the sphere, those above in proportion to their distance from the
        top: no node of the contact lies at a pole of a surface that gmsh meshes in parameters.
        """
        if self.end_radius is None:
            return points
        away = np.hypot(points[:, 0] - self.track_radius, points[:, 1])
        sphere = self._sphere(np.minimum(away, self.face_radius))
        below = 1 - points[:, 2] / (self.pin_height - self.face_height)
        lifted = points.copy()
        lifted[:, 2] += self.face_height - (self.face_height - sphere) * below
        return lifted

    def _sphere(self, away: np.ndarray) -> np.ndarray:
        """Height of the spherical end at distances from its axis [m]."""
        assert self.end_radius is not None
        return away**2 / (self.end_radius + np.sqrt(self.end_radius**2 - away**2))

    def _disk(self, order: int, sizes: RoundZone) -> MeshedBody:
        area = math.pi * (self.disk_outer_radius**2 - self.disk_inner_radius**2)
        unit, volume = self.pin_radius, area * self.disk_thickness
        return mesh_solid(lambda occ: _draw_disk(occ, self, unit), sizes, volume, order, unit)

    def _pin_claims(self) -> dict[str, Claim]:
        claims = {"top": self._at(self.pin_height), "side": every}
        if self.end_radius is None:
            return {"face": self._at(0.0)} | claims
        radius = self.end_radius
        top = (self.track_radius, 0.0, radius)

        def on_end(p: np.ndarray) -> np.ndarray:
            off = np.abs(np.linalg.norm(p - np.array(top), axis=-1) - radius)
            return np.all((off < self._tolerance) & (p[..., 2] < radius), axis=1)

        return {"face": both(on_end, self._under_pin)} | claims

    def _disk_claims(self) -> dict[str, Claim]:
        return {
            "face": both(self._at(0.0), self._under_pin),
            "rest": self._at(0.0),
            "bottom": self._at(-self.disk_thickness),
            "inside": self._on_radius(self.disk_inner_radius),
            "outside": every,
        }

    @property
    def _tolerance(self) -> float:
        return _SAME * self.pin_radius

    def _at(self, z: float) -> Claim:
        return lambda p: np.all(np.abs(p[..., 2] - z) < self._tolerance, axis=1)

    def _on_radius(self, radius: float) -> Claim:
        limit = self._tolerance + 1e-9 * radius
        return lambda p: np.all(np.abs(np.hypot(p[..., 0], p[..., 1]) - radius) < limit, axis=1)

    def _under_pin(self, p: np.ndarray) -> np.ndarray:
        away = np.hypot(p[..., 0] - self.track_radius, p[..., 1])
        return np.all(away < self.face_radius + self._tolerance, axis=1)


def _draw_pin(occ, sizes: PinOnDisk, unit: float) -> None:
    """Draw a pin whose end is flat within the contact face, see `PinOnDisk._rounded`."""
    axis, radius, height, face = (
        value / unit
        for value in (
            sizes.track_radius,
            sizes.pin_radius,
            sizes.pin_height - sizes.face_height,
            sizes.face_radius,
        )
    )
    beside = (sizes.end_height - sizes.face_height) / unit
    shaft = occ.addCylinder(axis, 0, beside, 0, 0, height - beside, radius)
    if face < radius * (1 - 1e-9):
        assert sizes.end_radius is not None
        ball, level = sizes.end_radius / unit, sizes.face_height / unit
        sphere = occ.addSphere(axis, 0, ball - level, ball)
        box = occ.addBox(axis - 2 * ball, -2 * ball, 0, 4 * ball, 4 * ball, beside)
        slice_, _ = occ.intersect([(3, sphere)], [(3, box)])
        occ.fuse(slice_, [(3, shaft)])


def _draw_disk(occ, sizes: PinOnDisk, unit: float) -> None:
    """Draw an annular disk with the outline of the contact face on it."""
    inner, outer, thickness, track, face = (
        value / unit
        for value in (
            sizes.disk_inner_radius,
            sizes.disk_outer_radius,
            sizes.disk_thickness,
            sizes.track_radius,
            sizes.face_radius,
        )
    )
    whole = occ.addCylinder(0, 0, -thickness, 0, 0, thickness, outer)
    bore = occ.addCylinder(0, 0, -thickness, 0, 0, thickness, inner)
    disk, _ = occ.cut([(3, whole)], [(3, bore)])
    occ.fragment(disk, [(2, occ.addDisk(track, 0, 0, face, face))])
