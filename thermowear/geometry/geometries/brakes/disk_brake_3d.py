"""Brake pad with back plate on a disk with hat, in space.

The contact lies at z = 0; the pad is above, about the x-axis. Both bodies consist of curved
tetrahedra made by gmsh, those of the disk in rows round its axis: the temperature of a fast disk,
nearly uniform round the axis, is then computed without spurious conduction across the motion.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Literal

import numpy as np
from pydantic import model_validator

from ....case.tables.geometry import Geometry, keyed, named
from ....case.values.section import KeyFault, Switch
from ....case.values.units import Angle, Length
from ...mesh.tagged import TaggedMesh
from ...meshing.cells import MeshedBody, tagged_bodies
from ...meshing.divisions import growing, joined
from ...meshing.tetrahedra import (
    SectorZone,
    check_revolved,
    mesh_polygon,
    mesh_solids,
    revolved,
    row_sizes,
)
from .brake_drawing import DrawnBrake
from .pad_outline import PadOutline

_RADII = (
    *("bore_radius", "hub_radius", "hat_radius"),
    *("pad_inner_radius", "pad_outer_radius", "disk_outer_radius"),
)
"""Radii in ascending order."""
_ORDER = 2
"""Largest cell order; never above the displacement degree, so that rigid rotations are exact."""
_WIDEST = math.radians(150)
"""Largest angle of a pad."""
_CLEARANCE = 0.01
"""Least distance of edges from each other, by the width of the pad."""
_FAR = 2.0
"""Largest elements by the size of those inside the contact."""
_FLAT = 1.5
"""Largest elements of the section of the disk by the thickness of the hat."""
_AROUND = 2.0
"""Largest length of the elements of the disk beside the pad by that of those below it."""
_BESIDE = 0.75
"""Size ratio of the elements of the disk beside the pad, towards it."""
_SLICE = math.radians(15)
"""Largest angle of an element of the disk."""
_DUTY = 400
"""Number of circles by which the duty factor is tabulated."""


class DiskBrakeInSpace(Geometry):
    """Dimensions of a brake pad and of a disk with hat, which rotates about the z-axis.

    ``mesh.elements`` is the number along the longer side of the pad. Elements at the edge of the
    contact are smaller by the factor ``mesh.grading``.

    Attributes
    ----------
    pad_inner_radius : float
        Inner radius of the pad [m].
    pad_outer_radius : float
        Outer radius of the pad [m].
    pad_angle : float
        Angle that the pad covers, symmetric about the x-axis [rad].
    pad_corner_radius : float or None
        Radius of its corners, sharp by default [m].
    pad_thickness : float
        Thickness of the lining [m].
    plate_thickness : float
        Thickness of the back plate [m].
    chamfer_length : float or None
        Length of the chamfers along both radial ends of the lining [m].
    chamfer_depth : float or None
        Depth of these chamfers [m].
    piston_radius : float
        Radius of the piston, which holds the back plate in the middle [m].
    disk_outer_radius : float
        Outer radius of the rubbed ring [m].
    disk_thickness : float
        Thickness of the rubbed ring of the whole disk [m].
    half : bool
        True if only the upper half of the ring is meshed, with its middle plane as a plane of
        symmetry: of a disk between two equal pads, with a hat on either side.
    hat_radius : float
        Outer radius of the hat, where the ring begins [m].
    hat_height : float
        Height of the hat above the rubbed face [m].
    hat_thickness : float
        Thickness of the wall of the hat and of its flange [m].
    bore_radius, hub_radius : float
        Radius of the hole in the flange; the flange is fixed to the hub up to `hub_radius` [m].
    """

    name = "disk-brake-3d"
    models = ("3d",)
    bodies = ("pad", "disk")
    zones = {"lining": "pad"}
    held = "pad_piston"
    fixed = "disk_hub"
    press_direction = (0.0, 0.0, -1.0)
    rotation_center = (0.0, 0.0)

    type: Literal["disk-brake-3d"]
    pad_inner_radius: Length
    pad_outer_radius: Length
    pad_angle: Angle
    pad_corner_radius: Length | None = None
    pad_thickness: Length
    plate_thickness: Length
    chamfer_length: Length | None = None
    chamfer_depth: Length | None = None
    piston_radius: Length
    disk_outer_radius: Length
    disk_thickness: Length
    half: Switch = False
    hat_radius: Length
    hat_height: Length
    hat_thickness: Length
    bore_radius: Length
    hub_radius: Length

    @model_validator(mode="after")
    def _nested(self):
        gap = _CLEARANCE * abs(self.pad_outer_radius - self.pad_inner_radius)
        room = {"hat_radius": self.hat_thickness}
        for smaller, larger in pairwise(_RADII):
            a, b, less = getattr(self, smaller), getattr(self, larger), room.get(larger, 0.0)
            if not a + less + gap <= b:
                wall = " less hat_thickness" if less else ""
                raise KeyFault(smaller, f"{a:g} m must be less than {larger} {b:g} m{wall}")
        if not self.hat_height > 1.05 * self.hat_thickness:
            raise KeyFault(
                "hat_height",
                f"{self.hat_height:g} m must be greater than 1.05 times hat_thickness "
                f"{self.hat_thickness:g} m",
            )
        return self

    @model_validator(mode="after")
    def _outlined(self):
        if not 0 < self.pad_angle <= _WIDEST * (1 + 1e-12):
            raise KeyFault(
                "pad_angle",
                f"{math.degrees(self.pad_angle):g} deg must be greater than 0 deg, "
                f"at most {math.degrees(_WIDEST):g} deg",
            )
        outline, (first, last) = self.outline, self.outline.straight
        if not (first < last and max(outline.corner_angles) < outline.half_angle):
            raise KeyFault(
                "pad_corner_radius",
                f"{outline.corner:g} m must be less than about half of the sides of the pad, "
                f"{outline.width:g} m wide and {outline.inner * self.pad_angle:.3g} m long inside",
            )
        self._check_chamfers()
        middle = (outline.inner + outline.outer) / 2
        largest = (1 - _CLEARANCE) * min(outline.width / 2, middle * math.sin(outline.half_angle))
        if not self.piston_radius <= largest:
            raise KeyFault(
                "piston_radius",
                f"{self.piston_radius:g} m must be at most {largest:.4g} m, so that the piston "
                "lies within the pad",
            )
        return self

    def _check_chamfers(self) -> None:
        keys = ("chamfer_length", "chamfer_depth")
        missing = [key for key in keys if getattr(self, key) is None]
        if len(missing) == 1:
            raise KeyFault(missing[0], "missing; chamfers need a length and a depth")
        if missing:
            return
        self.check_less("chamfer_depth", "pad_thickness")
        longest = 0.8 * self.pad_inner_radius * math.sin(min(self.pad_angle / 2, math.pi / 2))
        if not self.outline.corner <= self.outline.chamfer <= longest:
            raise KeyFault(
                "chamfer_length",
                f"{self.outline.chamfer:g} m must be at least pad_corner_radius "
                f"{self.outline.corner:g} m, at most {longest:.4g} m",
            )

    @property
    def outline(self) -> PadOutline:
        """Outline of the pad and its flat face."""
        return PadOutline(
            self.pad_inner_radius,
            self.pad_outer_radius,
            self.pad_angle / 2,
            self.pad_corner_radius or 0.0,
            self.chamfer_length or 0.0,
        )

    @property
    def ring_thickness(self) -> float:
        """Thickness of the ring as meshed [m]."""
        return self.disk_thickness / 2 if self.half else self.disk_thickness

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        far = ("middle",) if self.half else ("opposite", "back")
        disk = ("face", "rest", *far, "outside", "hub", "inside", "hat")
        return *named("pad", "face", "piston", "back", "sides"), *named("disk", *disk)

    @keyed
    def mid_plane(self) -> tuple[str, ...]:
        return ("disk_middle",) if self.half else ()

    @keyed
    def pivot_point(self) -> tuple[float, ...]:
        """Centroid of the pad's face."""
        return (self.outline.centroid, 0.0, 0.0)

    @keyed
    def duty_by_radius(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        outline = self.outline
        ends = (1 - np.cos(np.linspace(0, math.pi, _DUTY))) / 2  # denser at both edges
        radii = outline.inner + outline.width * ends
        return tuple(map(float, radii)), tuple(map(float, outline.duty(radii)))

    def contact_area(self) -> float:
        return self.outline.area

    def build(self, mesh, zone=None) -> TaggedMesh:
        drawn, order = DrawnBrake(self), min(mesh.degree, _ORDER)
        sizes = self._pad_sizes(*mesh.face("pad"))
        pad = mesh_solids(drawn.draw_pad, {"pad": sizes}, order, drawn.unit)["pad"]
        lining = pad.points[pad.cells[:, :4], 2].mean(axis=1) < self.pad_thickness
        pad = replace(pad, zones={"lining": np.flatnonzero(lining)})
        disk = self._disk(drawn, order, *mesh.face("disk"))
        tagged = tagged_bodies({"pad": pad, "disk": disk}, drawn.claims())
        return replace(tagged, cell_type="tetrahedron")

    def _largest(self, elements: int) -> float:
        """Element size inside the contact [m]."""
        return max(self.outline.length, self.outline.width) / elements

    def _pad_sizes(self, elements: int, grading: float) -> SectorZone:
        outline, inside = self.outline, self._largest(elements)
        return SectorZone(
            (outline.inner, outline.outer),
            outline.half_angle,
            (inside, grading * inside, _FAR * inside),
            self.pad_thickness + self.plate_thickness,
        )

    def _disk(self, drawn: DrawnBrake, order: int, elements: int, grading: float) -> MeshedBody:
        """Rows of cells round the axis, finer below the pad."""
        outline, inside = self.outline, self._largest(elements)
        around = 2 * max(1, round(outline.widest * outline.middle / inside)) + 1
        below = np.linspace(-outline.widest, outline.widest, around + 1)
        first, widest = float(np.diff(below).min()), min(_AROUND * inside / outline.middle, _SLICE)
        far = math.pi + 0.3 * widest  # no ends of layers in the plane y = 0, where pictures are cut
        before, after = (
            growing(start, end, first, _BESIDE, max(widest, first))
            for start, end in ((-outline.widest, far - 2 * math.pi), (outline.widest, far))
        )
        angles = joined(before, below, after)
        check_revolved(self.ring_thickness * outline.width, inside, len(angles) - 1)
        faces = (0.0,) if self.half else (0.0, -self.ring_thickness)
        radii = outline.inner, outline.outer
        sizes = row_sizes(radii, faces, (inside, grading * inside), drawn.unit)
        largest = min(_FAR * inside, _FLAT * self.hat_thickness)
        points, triangles = mesh_polygon(drawn.section(), sizes, largest, drawn.unit)
        return revolved(points, triangles, angles, order)
