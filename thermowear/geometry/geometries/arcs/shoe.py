"""Brake shoe with a lining inside a drum: its cells, and the position of its pivot.

Angles are measured from 12 o'clock (the direction +y), clockwise: positive towards +x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ....case.values.section import KeyFault
from ...meshing.cells import Claim, Sheet
from ...meshing.rings import Division, Polar

ORIGIN = Polar()
_LONGEST = math.radians(170.0)
_ON_THE_LINE = 1e-9
"""Moment arm, relative to the pivot's distance, that is zero up to rounding."""


def degrees(angle: float) -> str:
    return f"{math.degrees(angle):g} deg"


def check_order(arc: tuple[float, float]) -> None:
    """Reject an arc that ends before it starts."""
    start, end = arc
    if not start < end:
        raise KeyFault("arc_end", f"{degrees(end)} must be greater than arc_start {degrees(start)}")


def layered_sheets(
    division: Division, radius: float, arc: tuple[float, float], layers: tuple[float, ...]
) -> list[Sheet]:
    """Cells of the layers of a ring sector, from its outer arc inwards."""
    length = radius * float(np.ptp(arc))
    depths = division.layered(layers, length)
    return [ORIGIN.sheet(division.angles, radius - rows) for rows in depths]


@dataclass(frozen=True)
class Shoe:
    """Ring sector inside a drum about the origin, which rotates about a pivot.

    Attributes
    ----------
    drum_radius : float
        Radius of its face [m].
    arc : tuple of float
        Angles of the ends of its lining [rad].
    layers : tuple of float
        Radial thicknesses of the lining and of the shoe under it [m].
    pivot : tuple of float
        Centre of rotation; an end of the lining may lie on the line through it and the centre of
        the drum, where a rotation has no normal component [m].
    """

    drum_radius: float
    arc: tuple[float, float]
    layers: tuple[float, float]
    pivot: tuple[float, float]

    @property
    def inner_radius(self) -> float:
        return self.drum_radius - sum(self.layers)

    @property
    def outward(self) -> tuple[float, float]:
        """Outward direction at the middle of the lining."""
        middle = sum(self.arc) / 2
        return math.sin(middle), math.cos(middle)

    def normal_arm(self, angle: float) -> float:
        """Outward motion of the face per anticlockwise rotation about the pivot [m/rad]."""
        x, y = self.pivot
        return y * math.sin(angle) - x * math.cos(angle)

    def check(self) -> None:
        """Reject a shoe that does not fit into the drum, or that its pivot cannot press on it.

        Raises
        ------
        KeyFault
        """
        if not self.arc[1] - self.arc[0] <= _LONGEST:
            raise KeyFault(
                "arc_end",
                f"the lining covers {degrees(self.arc[1] - self.arc[0])} of the drum; must be "
                f"at most {degrees(_LONGEST)}",
            )
        if not self.inner_radius > 0:
            raise KeyFault(
                "shoe_thickness",
                f"{self.layers[1]:g} m and the lining must be thinner together than "
                f"drum_radius {self.drum_radius:g} m",
            )
        self._check_pivot()

    def _check_pivot(self) -> None:
        distance = math.hypot(*self.pivot)
        if not distance < self.drum_radius:
            raise KeyFault(
                "pivot",
                f"lies {distance:g} m from the centre; must be less than "
                f"drum_radius {self.drum_radius:g} m",
            )
        ends = [self.normal_arm(angle) for angle in self.arc]
        rounding = _ON_THE_LINE * distance
        outwards = min(ends) >= -rounding and max(ends) > rounding
        inwards = max(ends) <= rounding and min(ends) < -rounding
        if not outwards and not inwards:
            start, end = self.arc
            raise KeyFault(
                "pivot",
                f"lies at {degrees(math.atan2(*self.pivot))} clockwise from 12 o'clock (+y); must "
                f"lie neither within the lining, {degrees(start)} to {degrees(end)}, nor opposite "
                "to it, except at its ends: a rotation would press one part of the shoe and lift "
                "the other",
            )

    def sheets(self, division: Division, zone: str) -> list[Sheet]:
        """Cells of the lining, which is a zone, and of the shoe."""
        lining, shoe = layered_sheets(division, self.drum_radius, self.arc, self.layers)
        return [replace(lining, zone=zone), shoe]

    def face(self) -> Claim:
        """Predicate of the edges of its face."""
        return ORIGIN.circle(self.drum_radius)

    def inside(self) -> Claim:
        """Predicate of the edges of its inner arc, where it is held."""
        return ORIGIN.circle(self.inner_radius)
