"""Brake pad on a rotating disk, in space.

The contact lies at z = 0; the pad is above, a sector centred on the x-axis. The disk rotates
about the z-axis; its upper half is meshed over the full circumference, and fixed at its middle.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from ...case.tables.geometry import keyed, named
from ..meshing.blocks import SAME, Interval, ends_of, graded_face, growing, smallest
from ..meshing.hexes import Lattice, level, mesh_lattice
from ..meshing.quads import MeshedBody, tagged_bodies
from .pads_on_disk import PadsOnDisk

_WIDEST = math.radians(30)
"""Largest angle of an element of the disk beside the pad."""
_ORDER = 3
"""Largest cell order; never above the displacement degree, so that rigid rotations are exact."""


class DiskSector(PadsOnDisk):
    """Dimensions of pad and disk, see the base.

    ``mesh.elements`` is the number along the longer side of the pad; the shorter has fewer.
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

    @keyed
    def pivot_point(self) -> tuple[float, ...]:
        """Centroid of the pad's face."""
        r, R, half = self.pad_inner_radius, self.pad_outer_radius, self.pad_angle / 2
        return (2 / 3 * (R**3 - r**3) / (R**2 - r**2) * math.sin(half) / half, 0.0, 0.0)

    @keyed
    def duty(self) -> float:
        return self.pad_angle / (2 * math.pi)

    def build(self, mesh, zone=None):
        order = min(mesh.degree, _ORDER)
        pad, disk = self._pad(order, *mesh.face("pad")), self._disk(order, *mesh.face("disk"))
        pad_radii = (self.pad_inner_radius, self.pad_outer_radius)
        disk_radii = (self.disk_inner_radius, self.disk_outer_radius)
        return tagged_bodies(
            {"pad": pad, "disk": disk},
            {
                "pad_face": lambda p: level(p, 0.0),
                "pad_back": lambda p: level(p, self.pad_thickness),
                "pad_inside": lambda p: _on_radius(p, pad_radii[0]),
                "pad_outside": lambda p: _on_radius(p, pad_radii[1]),
                "pad_ends": lambda p: np.ones(len(p), dtype=bool),
                "disk_face": lambda p: level(p, 0.0) & self._under_pad(p),
                "disk_rest": lambda p: level(p, 0.0),
                "disk_middle": lambda p: level(p, -self.disk_thickness / 2),
                "disk_inside": lambda p: _on_radius(p, disk_radii[0]),
                "disk_outside": lambda p: _on_radius(p, disk_radii[1]),
            },
        )

    def _pad(self, order: int, elements: int, grading: float) -> MeshedBody:
        radii, angles = self._face(elements, grading)
        thin, largest = self._sizes(radii, angles, elements)
        rows = growing(0.0, self.pad_thickness, thin, grading, largest)
        ends = ends_of(radii), ends_of(angles), ends_of(rows)
        return mesh_lattice(Lattice(ends, _cylindrical_map), order)

    def _disk(self, order: int, elements: int, grading: float) -> MeshedBody:
        radii, angles = self._face(elements, grading)
        thin, largest = self._sizes(radii, angles, elements)
        inside = growing(self.pad_inner_radius, self.disk_inner_radius, thin, grading, largest)
        outside = growing(self.pad_outer_radius, self.disk_outer_radius, thin, grading, largest)
        first, half = thin / self._mean_radius, self.pad_angle / 2
        before, after = (
            growing(e, math.copysign(math.pi, e), first, grading, _WIDEST) for e in (-half, half)
        )
        rows = growing(0.0, -self.disk_thickness / 2, thin, grading, largest)
        ends = ends_of(inside + radii + outside), ends_of(before + angles + after), ends_of(rows)
        return mesh_lattice(Lattice(ends, _cylindrical_map, closed=True), order)

    def _face(self, elements: int, grading: float) -> tuple[list[Interval], list[Interval]]:
        """Divisions of the contact along the radius [m] and around the axis [rad]."""
        width, half = self.pad_outer_radius - self.pad_inner_radius, self.pad_angle / 2
        sides = np.array([width, self.pad_angle * self._mean_radius])
        across, along = (max(1, round(elements * side)) for side in sides / sides.max())
        return (
            graded_face(self.pad_inner_radius, self.pad_outer_radius, across, grading),
            graded_face(-half, half, along, grading),
        )

    def _sizes(self, radii, angles, elements: int) -> tuple[float, float]:
        """Element sizes next to the contact edges, and the largest ones far away [m]."""
        width = self.pad_outer_radius - self.pad_inner_radius
        thin = min(smallest(radii), smallest(angles) * self._mean_radius)
        return thin, 3.0 * max(width, self.pad_angle * self._mean_radius) / elements

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


def _on_radius(p: np.ndarray, radius: float) -> np.ndarray:
    """Mask of facets with all nodes at a radius."""
    return np.all(np.abs(np.hypot(p[..., 0], p[..., 1]) - radius) < 1e-9 * radius, axis=1)
