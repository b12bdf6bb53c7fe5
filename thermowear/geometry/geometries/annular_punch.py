"""Annular punch rotating about its axis on a plate (half section, r and z).

The punch is above the plate. Their faces coincide: flat at z = 0, or a cone or a torus through
z = 0 at the mean radius. Beside a face that is not flat the plate continues at constant height.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from pydantic import model_validator

from ...case.tables.geometry import named
from ...case.values.section import KeyFault
from ...case.values.units import Angle, Length
from ..mesh.tagged import TaggedMesh
from ..meshing.divisions import growing
from .stacked import Rectangle, Stacked

_STEEPEST = math.radians(80)
"""Largest slope of a face for which its cells remain well shaped."""

_DEEPEST = 0.9
"""Largest height of a face relative to the height of its body."""


class AnnularPunch(Stacked):
    """Dimensions of punch and plate.

    Attributes
    ----------
    inner_radius : float
        Inner radius of the punch [m].
    outer_radius : float
        Outer radius of the punch [m].
    plate_radius : float
        Radius of the plate [m].
    punch_height : float
        Height of the punch at the mean radius, from the face to the plane top [m].
    plate_height : float
        Height of the plate at the mean radius, from the face to the plane bottom [m].
    face : str
        ``"flat"``, ``"conical"`` or ``"toroidal"``.
    cone_angle : float or None
        Angle from the axis to the face, in the half section: the face rises outwards below 90° and
        falls above [rad].
    torus_radius : float or None
        Radius of the face in the half section, an arc convex towards the plate [m].
    """

    name = "annular-punch"
    models = ("axisymmetric",)
    bodies = ("punch", "plate")
    surfaces = (
        *named("punch", "face", "top", "inside", "outside"),
        *named("plate", "face", "bottom", "side"),
    )
    held = "punch_top"
    fixed = "plate_bottom"

    type: Literal["annular-punch"]
    inner_radius: Length
    outer_radius: Length
    punch_height: Length
    plate_radius: Length
    plate_height: Length
    face: Literal["flat", "conical", "toroidal"] = "flat"
    cone_angle: Angle | None = None
    torus_radius: Length | None = None

    @model_validator(mode="after")
    def _nested(self):
        self.check_less("inner_radius", "outer_radius")
        self.check_greater("plate_radius", "outer_radius")
        return self

    @model_validator(mode="after")
    def _shaped(self):
        keys = {"cone_angle": "conical", "torus_radius": "toroidal"}
        for key, face in keys.items():
            if self.face == face and getattr(self, key) is None:
                raise KeyFault(key, f"missing; a {face} face needs it")
            if self.face != face and getattr(self, key) is not None:
                raise KeyFault(key, f'requires face = "{face}"')
        if self.cone_angle is not None:
            self._check_angle(math.degrees(self.cone_angle))
            self._check_rise("cone_angle", "punch_height", "plate_height")
        if self.torus_radius is not None:
            least = (self.outer_radius - self.inner_radius) / 2 / math.sin(_STEEPEST)
            if not self.torus_radius >= least:
                raise KeyFault(
                    "torus_radius", f"{self.torus_radius:g} m must be at least {least:.4g} m"
                )
            self._check_rise("torus_radius", "punch_height")
        return self

    def _check_angle(self, degrees: float) -> None:
        level, steepest = 90.0, math.degrees(_STEEPEST)
        if not abs(degrees - level) <= steepest * (1 + 1e-12):
            raise KeyFault(
                "cone_angle",
                f"{degrees:g} deg must be from {level - steepest:g} deg to "
                f"{level + steepest:g} deg (90 deg is flat)",
            )

    def _check_rise(self, key: str, *heights: str) -> None:
        rise = abs(float(self._height(np.array(self.outer_radius))))
        for name in heights:
            largest = _DEEPEST * getattr(self, name)
            if not rise < largest:
                raise KeyFault(
                    key,
                    f"puts the edge of the face {rise:.4g} m off its middle; "
                    f"must be less than {largest:.4g} m, {_DEEPEST:g} of {name}",
                )

    @property
    def upper(self) -> Rectangle:
        return Rectangle(self.inner_radius, self.outer_radius, self.punch_height)

    @property
    def lower(self) -> Rectangle:
        return Rectangle(0.0, self.plate_radius, self.plate_height)

    @property
    def cell_order(self) -> int:
        return 1 if self.torus_radius is None else 3

    @property
    def _middle(self) -> float:
        """Mean radius, where the face is at z = 0 [m]."""
        return (self.inner_radius + self.outer_radius) / 2

    def _height(self, radii: np.ndarray) -> np.ndarray:
        """Z of the face at radii [m]."""
        offset, radius = radii - self._middle, self.torus_radius
        if radius is not None:
            return 2 * radius * np.sin(np.arcsin(offset / radius) / 2) ** 2
        return offset * (0.0 if self.cone_angle is None else 1 / math.tan(self.cone_angle))

    def _spaced(self, radii: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Map equally spaced radii to the nodes of cells that end at `columns` [m]."""
        radius = self.torus_radius
        if radius is None:
            return radii
        # equal angles: points between the nodes then lie within 3e-4 h⁴/R³ of the arc
        after = np.clip(np.searchsorted(columns, radii, side="right"), 1, len(columns) - 1)
        part = (radii - columns[after - 1]) / (columns[after] - columns[after - 1])
        angles = np.arcsin((columns - self._middle) / radius)
        angle = (1 - part) * angles[after - 1] + part * angles[after]
        return self._middle + radius * np.sin(angle)

    def contact_area(self) -> float:
        """Area projected along the axis, also of a cone or a torus."""
        return math.pi * (self.outer_radius**2 - self.inner_radius**2)

    def _beside(self, sizes, elements, grading):
        contact, _, largest = sizes
        _, outside = super()._beside(sizes, elements, grading)
        # no graded rows at the axis
        return growing(self.inner_radius, 0.0, contact, grading, largest), outside

    def build(self, mesh, zone=None) -> TaggedMesh:
        flat = super().build(mesh, zone)
        points = flat.points.copy()
        for tag, height in enumerate((self.punch_height, -self.plate_height), start=1):
            cells = flat.cells[flat.cell_tags == tag]
            nodes, columns = np.unique(cells), np.unique(flat.points[cells[:, :4], 0])
            points[nodes] = self._to_profile(flat.points[nodes], columns, height)
        return replace(flat, points=points)

    def _to_profile(self, points: np.ndarray, columns: np.ndarray, height: float) -> np.ndarray:
        """Map points (n, 2) of a body so that its flat face becomes the profile.

        The far end at z = `height` stays; `columns` are the radii of the element ends [m].
        """
        limits = self.inner_radius, self.outer_radius
        r, z = points.T
        within = np.clip(r, *limits)
        on_face = self._spaced(within, np.unique(np.clip(columns, *limits)))
        part = 1 - z / height
        return np.column_stack([r + part * (on_face - within), z + part * self._height(on_face)])
