"""Brake pads on a rotating disk: as a ring in a half section (r and z), and in space.

The contact lies at z = 0; the pad is above. The disk is symmetric about its middle, with pads on
both sides; its upper half is meshed.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import ClassVar, Literal

import numpy as np
from pydantic import model_validator

from ....case.tables.geometry import Geometry, keyed, named
from ....case.values.section import KeyFault, Switch
from ....case.values.units import Angle, Length
from ...meshing.cells import (
    Claim,
    MeshedBody,
    both,
    every,
    level,
    mesh_lattice,
    tagged_bodies,
)
from ...meshing.divisions import SAME, graded_face, growing, joined
from ..stacked import Rectangle, Stacked

_WIDEST = math.radians(30)
"""Largest angle of an element of the disk beside the pad."""
_ORDER = 3
"""Largest cell order; never above the displacement degree, so that rigid rotations are exact."""


class PadsOnDisk(Geometry):
    """Base class: a disk, symmetric about its middle, of which the upper half is meshed.

    Attributes
    ----------
    pad_inner_radius : float
        Inner radius of the pads [m].
    pad_outer_radius : float
        Outer radius of the pads [m].
    pad_thickness : float
        Thickness of a pad [m].
    pad_angle : float
        Angle covered by all pads on one side of the disk [rad].
    disk_inner_radius : float
        Inner radius of the disk, less than that of the pads [m].
    disk_outer_radius : float
        Outer radius of the disk, greater than that of the pads [m].
    disk_thickness : float
        Thickness of the whole disk, half of which is meshed [m].
    widest_pad : float
        Largest `pad_angle` that can be meshed [deg].
    """

    bodies = ("pad", "disk")
    held = "pad_back"
    fixed = "disk_middle"
    widest_pad: ClassVar[float]

    pad_inner_radius: Length
    pad_outer_radius: Length
    pad_thickness: Length
    pad_angle: Angle
    disk_inner_radius: Length
    disk_outer_radius: Length
    disk_thickness: Length

    @model_validator(mode="after")
    def _nested(self):
        names = ("disk_inner_radius", "pad_inner_radius", "pad_outer_radius", "disk_outer_radius")
        for smaller, larger in pairwise(names):
            a, b = getattr(self, smaller), getattr(self, larger)
            if not a < b and larger == "pad_outer_radius":
                raise KeyFault(smaller, f"{a:g} m must be less than {larger} {b:g} m")
            if not a <= b * (1 + SAME):
                raise KeyFault(smaller, f"{a:g} m must be at most {larger} {b:g} m")
        if not 0 < self.pad_angle <= math.radians(self.widest_pad) * (1 + 1e-12):
            raise KeyFault(
                "pad_angle",
                f"{math.degrees(self.pad_angle):g} deg must be greater than 0 deg, "
                f"at most {self.widest_pad:g} deg",
            )
        return self

    def contact_area(self) -> float:
        """Area of the pads on one side."""
        return self.pad_angle / 2 * (self.pad_outer_radius**2 - self.pad_inner_radius**2)


class DiskBrake(PadsOnDisk, Stacked):
    """Dimensions of pads and disk of a half section.

    Deformation and temperature are those of a pad covering the full circumference; resultants on
    the pads, which cover a sector, are those of the ring times that sector. Pressure and rigid
    motions are therefore exact, while the ends of the pads are neglected in the elasticity. The
    middle plane of the disk is constrained axially only: it is both fixed and on rollers.
    """

    name = "disk-brake"
    models = ("axisymmetric",)
    widest_pad = 360.0
    rollers = ("disk_middle",)
    mirror = ("disk_middle",)

    type: Literal["disk-brake"]

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        disk = named("disk", "face", "middle", "outside", "inside")
        rest = () if self.covers else ("disk_rest",)
        return *named("pad", "face", "back", "inside", "outside"), *disk, *rest

    @property
    def upper(self) -> Rectangle:
        return Rectangle(self.pad_inner_radius, self.pad_outer_radius, self.pad_thickness)

    @property
    def lower(self) -> Rectangle:
        return Rectangle(self.disk_inner_radius, self.disk_outer_radius, self.disk_thickness / 2)

    @keyed
    def sector(self) -> float:
        return self.pad_angle / (2 * math.pi)


class DiskSector(PadsOnDisk):
    """Dimensions of pad and disk in space.

    The pad is a sector centred on the x-axis. The disk rotates about the z-axis and is meshed over
    the full circumference. ``mesh.elements`` is the number along the longer side of the pad; the
    shorter has fewer.

    Attributes
    ----------
    hub : bool
        True if the disk is clamped at its inside, and its middle plane is a plane of symmetry; by
        default the whole middle plane is clamped.
    """

    name = "disk-sector"
    models = ("3d",)
    widest_pad = 300.0
    surfaces = (
        *named("pad", "face", "back", "inside", "outside", "ends"),
        *named("disk", "face", "rest", "middle", "inside", "outside"),
    )
    press_direction = (0.0, 0.0, -1.0)
    rotation_center = (0.0, 0.0)

    type: Literal["disk-sector"]
    hub: Switch = False

    @keyed
    def fixed(self) -> str:
        return "disk_inside" if self.hub else "disk_middle"

    @keyed
    def mid_plane(self) -> tuple[str, ...]:
        return ("disk_middle",) if self.hub else ()

    @keyed
    def pivot_point(self) -> tuple[float, ...]:
        """Centroid of the pad's face."""
        r, R, half = self.pad_inner_radius, self.pad_outer_radius, self.pad_angle / 2
        return (2 / 3 * (R**3 - r**3) / (R**2 - r**2) * math.sin(half) / half, 0.0, 0.0)

    @keyed
    def duty(self) -> float:
        return self.pad_angle / (2 * math.pi)

    def build(self, mesh, zone=None):
        order, at_face = min(mesh.degree, _ORDER), level(2, 0.0)
        pad, disk = self._pad(order, *mesh.face("pad")), self._disk(order, *mesh.face("disk"))
        return tagged_bodies(
            {"pad": pad, "disk": disk},
            {
                "pad_face": at_face,
                "pad_back": level(2, self.pad_thickness),
                "pad_inside": _on_radius(self.pad_inner_radius),
                "pad_outside": _on_radius(self.pad_outer_radius),
                "pad_ends": every,
                "disk_face": both(at_face, self._under_pad),
                "disk_rest": at_face,
                "disk_middle": level(2, -self.disk_thickness / 2),
                "disk_inside": _on_radius(self.disk_inner_radius),
                "disk_outside": _on_radius(self.disk_outer_radius),
            },
        )

    def _pad(self, order: int, elements: int, grading: float) -> MeshedBody:
        radii, angles, thin, largest = self._face(elements, grading)
        rows = growing(0.0, self.pad_thickness, thin, grading, largest)
        return mesh_lattice((radii, angles, rows), order, _cylindrical_map)

    def _disk(self, order: int, elements: int, grading: float) -> MeshedBody:
        radii, angles, thin, largest = self._face(elements, grading)
        inside = growing(self.pad_inner_radius, self.disk_inner_radius, thin, grading, largest)
        outside = growing(self.pad_outer_radius, self.disk_outer_radius, thin, grading, largest)
        first, half = thin / self._mean_radius, self.pad_angle / 2
        before, after = (
            growing(e, math.copysign(math.pi, e), first, grading, _WIDEST) for e in (-half, half)
        )
        rows = growing(0.0, -self.disk_thickness / 2, thin, grading, largest)
        ends = joined(inside, radii, outside), joined(before, angles, after), rows
        return mesh_lattice(ends, order, _cylindrical_map, closed=True)

    def _face(self, elements: int, grading: float) -> tuple[np.ndarray, np.ndarray, float, float]:
        """Divisions of the contact along the radius [m] and around the axis [rad].

        Also the element size next to the contact edges, and the largest one far away [m].
        """
        width, half = self.pad_outer_radius - self.pad_inner_radius, self.pad_angle / 2
        sides = np.array([width, self.pad_angle * self._mean_radius])
        across, along = (max(1, round(elements * side)) for side in sides / sides.max())
        radii = graded_face(self.pad_inner_radius, self.pad_outer_radius, across, grading)
        angles = graded_face(-half, half, along, grading)
        thin = min(np.diff(radii).min(), np.diff(angles).min() * self._mean_radius)
        return radii, angles, float(thin), 3.0 * float(sides.max()) / elements

    @property
    def _mean_radius(self) -> float:
        return (self.pad_inner_radius + self.pad_outer_radius) / 2

    def _under_pad(self, p: np.ndarray) -> np.ndarray:
        """Mask of facets with all nodes under the pad or at its edges."""
        r, angle = np.hypot(p[..., 0], p[..., 1]), np.abs(np.arctan2(p[..., 1], p[..., 0]))
        between = (r > (1 - SAME) * self.pad_inner_radius) & (
            r < (1 + SAME) * self.pad_outer_radius
        )
        return np.all(between & (angle < (1 + SAME) * self.pad_angle / 2), axis=1)


def _cylindrical_map(p: np.ndarray) -> np.ndarray:
    """Map of radius, angle and z to x, y and z."""
    r, angle, z = np.moveaxis(p, -1, 0)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)


def _on_radius(radius: float) -> Claim:
    """Predicate of the facets with all nodes at a distance from the z-axis."""
    return lambda p: np.all(np.abs(np.hypot(p[..., 0], p[..., 1]) - radius) < 1e-9 * radius, axis=1)
