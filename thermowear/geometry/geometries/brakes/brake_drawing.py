"""Drawing of a brake pad and the section of a disk with hat, and the names of their surfaces."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...meshing.cells import Claim, both, every
from .pad_outline import PadOutline

_SAME = 1e-7
"""Tolerance for positions of nodes on a surface, by the width of the pad."""


class BrakeSizes(Protocol):
    """Dimensions of pad and disk, see `disk_brake_3d.DiskBrakeInSpace`."""

    @property
    def outline(self) -> PadOutline: ...
    @property
    def pad_thickness(self) -> float: ...
    @property
    def plate_thickness(self) -> float: ...
    @property
    def piston_radius(self) -> float: ...
    @property
    def chamfer_depth(self) -> float | None: ...
    @property
    def disk_outer_radius(self) -> float: ...
    @property
    def hat_radius(self) -> float: ...
    @property
    def hat_height(self) -> float: ...
    @property
    def hat_thickness(self) -> float: ...
    @property
    def bore_radius(self) -> float: ...
    @property
    def hub_radius(self) -> float: ...
    @property
    def half(self) -> bool: ...
    @property
    def ring_thickness(self) -> float: ...


@dataclass(frozen=True)
class DrawnBrake:
    """Pad, and section of the disk, whose cells have edges along the sides of the pad.

    Attributes
    ----------
    sizes : BrakeSizes
    """

    sizes: BrakeSizes

    @property
    def unit(self) -> float:
        """Length in which it is drawn [m]."""
        return self.sizes.outline.width

    def draw_pad(self, occ) -> dict[str, list[int]]:
        """Draw the pad with the outline of the piston; returns its volumes by its name."""
        parts = occ.fragment(self._pad(occ), [(2, self._piston(occ))])[0]
        return {"pad": [tag for dim, tag in parts if dim == 3]}

    def _lengths(self, *lengths: float) -> tuple[float, ...]:
        return tuple(length / self.unit for length in lengths)

    def _pad(self, occ) -> list[tuple[int, int]]:
        """Lining and back plate."""
        lining, plate = self._lengths(self.sizes.pad_thickness, self.sizes.plate_thickness)
        face = self._outline(occ)
        below = [tag for tag in occ.extrude([(2, face)], 0, 0, lining) if tag[0] == 3]
        above = occ.copy([(2, face)])
        occ.translate(above, 0, 0, lining)
        above = [tag for tag in occ.extrude(above, 0, 0, plate) if tag[0] == 3]
        if self.sizes.outline.chamfer > 0:
            below = occ.cut(below, self._chamfers(occ))[0]
        return below + above

    def _outline(self, occ) -> int:
        """Surface of the outline without chamfers, at z = 0."""
        outline = self.sizes.outline
        inner, outer, corner = self._lengths(outline.inner, outline.outer, outline.corner)
        first, last = self._lengths(*outline.straight)
        a, (within, beyond) = outline.half_angle, outline.corner_angles
        arcs = (inner, within), (outer, beyond)

        def point(radius: float, angle: float) -> int:
            return occ.addPoint(radius * math.cos(angle), radius * math.sin(angle), 0.0)

        axis = occ.addPoint(0, 0, 0)
        # from the inner arc along one end of the pad to the outer arc
        low, high = ([point(r, side * (a - off)) for side in (-1, 1)] for r, off in arcs)
        curves = [occ.addCircleArc(low[0], axis, low[1])]
        sides = []
        for side, start, end in zip((-1, 1), low, high, strict=True):
            if corner > 0:
                begin, stop = point(first, side * a), point(last, side * a)
                side_curves = [
                    occ.addCircleArc(start, point(inner + corner, side * (a - within)), begin),
                    occ.addLine(begin, stop),
                    occ.addCircleArc(stop, point(outer - corner, side * (a - beyond)), end),
                ]
            else:
                side_curves = [occ.addLine(start, end)]
            sides.append(side_curves)
        curves += [*sides[1], occ.addCircleArc(high[1], axis, high[0]), *sides[0][::-1]]
        return occ.addPlaneSurface([occ.addWire(curves)])

    def _chamfers(self, occ) -> list[tuple[int, int]]:
        """Wedges to be cut off at both ends of the lining."""
        outline, depth = self.sizes.outline, self.sizes.chamfer_depth
        assert depth is not None
        length, depth, far = self._lengths(outline.chamfer, depth, outline.outer)
        past = 1.0  # beyond the end and below the face, so that no faces coincide
        slope, wedges = depth / length, []
        for side in (-1, 1):
            # section along x = 0, with y = 0 at the end; turned to the end of the pad
            corners = [(-length - past, -slope * past), (past, depth + slope * past)]
            corners.append((past, -slope * past))
            points = [occ.addPoint(0.0, side * y, z) for y, z in corners]
            lines = [occ.addLine(points[i], points[(i + 1) % 3]) for i in range(3)]
            section = [(2, occ.addPlaneSurface([occ.addWire(lines)]))]
            wedge = [tag for tag in occ.extrude(section, 2 * far, 0, 0) if tag[0] == 3]
            occ.rotate(wedge, 0, 0, 0, 0, 0, 1, side * outline.half_angle)
            wedges += wedge
        return wedges

    def _piston(self, occ) -> int:
        sizes = self.sizes
        x, z, radius = self._lengths(
            (sizes.outline.inner + sizes.outline.outer) / 2,
            sizes.pad_thickness + sizes.plate_thickness,
            sizes.piston_radius,
        )
        return occ.addDisk(x, 0, z, radius, radius)

    def section(self) -> np.ndarray:
        """Corners of the section of ring and hat, by distance from the axis and z, (n, 2) [m].

        Also the points of rubbed faces below the edges of the pad.
        """
        sizes, outline = self.sizes, self.sizes.outline
        hat, thickness, height = sizes.hat_radius, sizes.hat_thickness, sizes.hat_height
        bottom, inside, outside = -sizes.ring_thickness, hat - thickness, sizes.disk_outer_radius
        far = [] if sizes.half else [(outline.inner, bottom), (outline.outer, bottom)]
        corners = [(inside, bottom), *far, (outside, bottom), (outside, 0.0)]
        corners += [(outline.outer, 0.0), (outline.inner, 0.0), (hat, 0.0), (hat, height)]
        corners += [(sizes.bore_radius, height), (sizes.bore_radius, height - thickness)]
        flange = height - thickness
        return np.array([*corners, (sizes.hub_radius, flange), (inside, flange)])

    def claims(self) -> dict[str, Claim]:
        """Predicates of all surfaces, see `tagged_bodies`."""
        sizes, outline = self.sizes, self.sizes.outline
        top, bottom = sizes.pad_thickness + sizes.plate_thickness, -sizes.ring_thickness
        flange = sizes.hat_height - sizes.hat_thickness
        under = both(self._between(outline.inner, outline.outer), _around(outline.widest))
        disk = {
            "disk_face": both(self._at(0.0), under),
            "disk_rest": self._at(0.0),
        }
        if sizes.half:
            disk["disk_middle"] = self._at(bottom)
        else:
            disk |= {"disk_opposite": both(self._at(bottom), under), "disk_back": self._at(bottom)}
        return {
            "pad_face": self._at(0.0),
            "pad_piston": both(self._at(top), self._under_piston),
            "pad_back": self._at(top),
            "pad_sides": every,
            **disk,
            "disk_outside": self._on_radius(sizes.disk_outer_radius),
            "disk_hub": both(self._at(flange), self._between(0.0, sizes.hub_radius)),
            "disk_inside": self._on_radius(sizes.hat_radius - sizes.hat_thickness),
            "disk_hat": every,
        }

    @property
    def _tolerance(self) -> float:
        return _SAME * self.unit

    def _at(self, z: float) -> Claim:
        return lambda p: np.all(np.abs(p[..., 2] - z) < self._tolerance, axis=1)

    def _on_radius(self, radius: float) -> Claim:
        return lambda p: np.all(
            np.abs(np.hypot(p[..., 0], p[..., 1]) - radius) < self._tolerance, axis=1
        )

    def _between(self, inner: float, outer: float) -> Claim:
        """Predicate of the facets with all nodes between two distances from the axis."""

        def claim(p: np.ndarray) -> np.ndarray:
            r = np.hypot(p[..., 0], p[..., 1])
            within = (r > inner - self._tolerance) & (r < outer + self._tolerance)
            return np.all(within, axis=1)

        return claim

    def _under_piston(self, p: np.ndarray) -> np.ndarray:
        outline = self.sizes.outline
        away = np.hypot(p[..., 0] - (outline.inner + outline.outer) / 2, p[..., 1])
        return np.all(away < self.sizes.piston_radius + self._tolerance, axis=1)


def _around(half_angle: float) -> Claim:
    """Predicate of the facets whose middle is within an angle to both sides of the x-axis."""

    def claim(p: np.ndarray) -> np.ndarray:
        x, y, _ = p.mean(axis=1).T
        return np.abs(np.arctan2(y, x)) < half_angle

    return claim
