"""Geometries whose body 1 is pressed on a rectangular block at the origin: cylinder and sphere.

A circular section touches the block at the origin. The lower half of the disc is meshed (or the
right half of that); it is held on the flat at the height of its centre.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import ClassVar, Literal

import numpy as np

from ...case.tables.geometry import Geometry, keyed, named
from ...case.tables.plane_geometry import HalvableGeometry
from ...case.values.pressing import Pressing
from ...case.values.units import Length
from ...errors import CaseError
from ..meshing.cells import (
    ORDER,
    Claim,
    MeshedBody,
    between,
    both,
    level,
    mesh_body,
    tagged_bodies,
)
from ..meshing.divisions import face_ends, growth, row_ratio
from ..meshing.rings import Disc, Polar, RectangularOutline, ringed_body

_THINNEST = 1e-6
"""Least contact width relative to the block's half width: 10 000 times the tolerance for positions
in the mesh, and finer than any element."""


def expected_half_width(pressing: Pressing, radius: float, thickness: float) -> float:
    """Half-width of the contact of cylinders: Hertz for a force, an estimate for an approach [m].

    Parameters
    ----------
    pressing : Pressing
    radius : float
        Relative radius of curvature [m].
    thickness : float
        Length of the contact that the force refers to [m].
    """
    if pressing.force is not None:
        return math.sqrt(4 * pressing.force / thickness * radius / (math.pi * pressing.modulus))
    assert pressing.approach is not None
    return 0.7 * math.sqrt(radius * pressing.approach)


class OnBlock(Geometry):
    """Base class: a block below y = 0, with the contact in the middle of its top.

    Attributes
    ----------
    block_height : float
        Height of the block [m].
    block_key : str
        Key of the block's size along the contact.
    """

    block_key: ClassVar[str]

    block_height: Length

    @keyed
    def held(self) -> str:
        return f"{self.bodies[0]}_top"

    @keyed
    def fixed(self) -> str:
        return f"{self.bodies[1]}_bottom"

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        upper, block = self.bodies
        on_block = named(block, "face", "top", "side", "bottom")
        return *named(upper, "face", "side", "top"), *on_block, *self.symmetry

    @property
    def right_only(self) -> bool:
        """True if only x >= 0 is meshed."""
        return True

    @property
    @abstractmethod
    def block_reach(self) -> float:
        """Distance of the block's side from x = 0 [m]."""

    @abstractmethod
    def upper_limits(self) -> dict[str, float]:
        """Keys of body 1 that bound the contact, and its largest distance from x = 0 [m]."""

    @abstractmethod
    def upper_body(self, mesh, zone: tuple[float, float]) -> tuple[MeshedBody, dict[str, Claim]]:
        """Mesh body 1 for a contact zone.

        Returns
        -------
        MeshedBody
        claims : dict of str to callable
            Predicates of its surfaces by the last word of their names, see `tagged_bodies`.
        """

    def block_ends(self, mesh, zone: tuple[float, float]) -> tuple[np.ndarray, float, float]:
        """Element ends along the top of the block, and row sizes below the contact.

        Returns
        -------
        ends : ndarray
            Ends of elements on the contact face and beside it, see `face_ends`.
        first, ratio : float
            Size of the first row below it [m], and ratio of successive rows.
        """
        elements, grading = mesh.face(self.bodies[1])
        limit = 0.9 * self.block_reach
        ends, largest = face_ends(zone, elements, grading, self.right_only, (-limit, limit))
        return ends, largest, row_ratio(elements)

    def block_span(self, ends: np.ndarray) -> tuple[float, float]:
        """Range of x of the block's contact face."""
        return float(ends[0]), float(ends[-1])

    def build(self, mesh, zone):
        self.check_zone(zone)
        upper, block = self.bodies
        upper_body, upper_claims = self.upper_body(mesh, zone)
        ends, *rows = self.block_ends(mesh, zone)
        outline = RectangularOutline(self.block_reach, self.block_height, self.right_only)
        sheets = ringed_body(outline, ends, rows, growth(mesh.face(block)[0]))
        claims = {f"{upper}_{part}": claim for part, claim in upper_claims.items()}
        on_top = level(1, 0.0)
        claims |= {
            f"{block}_face": both(on_top, between(*self.block_span(ends))),
            f"{block}_top": on_top,
            f"{block}_side": lambda p: level(0, self.block_reach)(np.abs(p)),
            f"{block}_bottom": level(1, -self.block_height),
            **dict.fromkeys(self.symmetry, level(0, 0.0)),
        }
        bodies = {upper: upper_body, block: mesh_body(sheets, ORDER)}
        return tagged_bodies(bodies, {surface: claims[surface] for surface in self.surfaces})

    def check_zone(self, zone: tuple[float, float]) -> None:
        outer = zone[1] if self.right_only else max(-zone[0], zone[1])
        if not outer > max(zone[0], 0.0):
            raise CaseError(
                f"geometry: the contact zone from x = {zone[0]:.3g} to {zone[1]:.3g} m is empty"
            )
        least = _THINNEST * self.block_reach
        if not zone[1] - zone[0] >= least:
            raise CaseError(
                f"geometry: the contact is expected to be {zone[1] - zone[0]:.3g} m wide; for "
                f"this {self.block_key} the least width that can be meshed is {least:.3g} m"
            )
        limits = self.upper_limits() | {self.block_key: 0.75 * self.block_reach}
        for key, limit in limits.items():
            if not outer <= limit:
                raise CaseError(
                    f"geometry.{key}: too small for the contact, which is expected up to "
                    f"x = {outer:.3g} m; it can be meshed up to {limit:.3g} m"
                )


class PlaneOnBlock(OnBlock, HalvableGeometry):
    """Base of geometries on a block for plane models.

    Attributes
    ----------
    block_width : float
        Width of the block, |x| <= block_width / 2 [m].
    """

    models = ("plane-strain", "plane-stress")
    block_key = "block_width"

    block_width: Length

    @keyed
    def symmetry(self) -> tuple[str, ...]:
        return tuple(f"{body}_axis" for body in self.bodies) if self.half else ()

    @property
    def right_only(self) -> bool:
        return self.half

    @property
    def block_reach(self) -> float:
        return self.block_width / 2


class RoundOnBlock(OnBlock):
    """Base class: body 1 has a circular section.

    Attributes
    ----------
    radius : float
        Radius of the rounded body [m].
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
    block_radius : float
        Radius of the block [m].
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
