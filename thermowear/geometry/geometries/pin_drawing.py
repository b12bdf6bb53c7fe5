"""Drawing of a round pin and a disk for gmsh, and the names of their surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..meshing.cells import Claim, both, every

_SAME = 1e-7
"""Tolerance for positions of nodes on a surface, by the radius of the pin."""


class PinSizes(Protocol):
    """Dimensions of pin and disk, see `pin_on_disk.PinOnDisk`."""

    @property
    def track_radius(self) -> float: ...
    @property
    def pin_radius(self) -> float: ...
    @property
    def pin_height(self) -> float: ...
    @property
    def end_radius(self) -> float | None: ...
    @property
    def end_height(self) -> float: ...
    @property
    def disk_inner_radius(self) -> float: ...
    @property
    def disk_outer_radius(self) -> float: ...
    @property
    def disk_thickness(self) -> float: ...
    def sphere(self, away: np.ndarray) -> np.ndarray:
        """Height of a spherical end at distances from its axis [m]."""


@dataclass(frozen=True)
class DrawnPin:
    """Pin and disk with the outline of the contact faces.

    The pin is drawn with an end that is flat within the contact face and rounded afterwards: no
    node of the contact lies at a pole of a surface that gmsh meshes in parameters, and the faces of
    pin and disk can have the same triangles.

    Attributes
    ----------
    sizes : PinSizes
    face : float
        Radius of the contact faces [m].
    """

    sizes: PinSizes
    face: float

    @property
    def unit(self) -> float:
        """Length in which it is drawn [m]."""
        return self.sizes.pin_radius

    @property
    def rise(self) -> float:
        """Height of the edge of the contact face of the pin, 0 for a flat end [m]."""
        flat = self.sizes.end_radius is None
        return 0.0 if flat else float(self.sizes.sphere(np.array(self.face)))

    def draw(self, names: tuple[str, ...], occ) -> dict[str, list[int]]:
        """Draw some of the bodies; returns their volumes by name."""
        drawn = [(3, self._pin(occ) if name == "pin" else self._disk(occ)) for name in names]
        outline = (2, occ.addDisk(self.sizes.track_radius / self.unit, 0, 0, *self._radii))
        parts = occ.fragment(drawn, [outline])[1]
        return {
            name: [tag for dim, tag in part if dim == 3]
            for name, part in zip(names, parts[: len(names)], strict=True)
        }

    @property
    def _radii(self) -> tuple[float, float]:
        """Half-axes of the face, in the unit."""
        return self.face / self.unit, self.face / self.unit

    def _pin(self, occ) -> int:
        sizes, unit = self.sizes, self.unit
        axis, height = sizes.track_radius / unit, (sizes.pin_height - self.rise) / unit
        beside = (sizes.end_height - self.rise) / unit
        if not beside > 1e-9:
            return occ.addCylinder(axis, 0, 0, 0, 0, height, 1.0)
        assert sizes.end_radius is not None
        ball = sizes.end_radius / unit
        shaft = occ.addCylinder(axis, 0, beside, 0, 0, height - beside, 1.0)
        sphere = occ.addSphere(axis, 0, ball - self.rise / unit, ball)
        box = occ.addBox(axis - 2 * ball, -2 * ball, 0, 4 * ball, 4 * ball, beside)
        slice_, _ = occ.intersect([(3, sphere)], [(3, box)])
        ((_, tag),) = occ.fuse(slice_, [(3, shaft)])[0]
        return tag

    def _disk(self, occ) -> int:
        sizes, unit = self.sizes, self.unit
        thickness = sizes.disk_thickness / unit
        whole, bore = (
            (3, occ.addCylinder(0, 0, -thickness, 0, 0, thickness, radius / unit))
            for radius in (sizes.disk_outer_radius, sizes.disk_inner_radius)
        )
        ((_, tag),) = occ.cut([whole], [bore])[0]
        return tag

    def rounded(self, points: np.ndarray) -> np.ndarray:
        """Points of the pin with its end rounded.

        Nodes of the flat face are moved to the sphere, those above in proportion to their distance
        from the top.
        """
        sizes = self.sizes
        if sizes.end_radius is None:
            return points
        away = np.hypot(points[:, 0] - sizes.track_radius, points[:, 1])
        sphere = sizes.sphere(np.minimum(away, self.face))
        part = 1 - points[:, 2] / (sizes.pin_height - self.rise)
        result = points.copy()
        result[:, 2] += self.rise - (self.rise - sphere) * part
        return result

    def claims(self) -> dict[str, Claim]:
        """Predicates of all surfaces, see `tagged_bodies`."""
        sizes = self.sizes
        inside = _on_radius(sizes.disk_inner_radius, self._tolerance)
        return {
            "pin_face": both(self._on_end, self._under_pin),
            "pin_top": self._at(sizes.pin_height),
            "pin_side": every,
            "disk_face": both(self._at(0.0), self._under_pin),
            "disk_rest": self._at(0.0),
            "disk_bottom": self._at(-sizes.disk_thickness),
            "disk_inside": inside,
            "disk_outside": every,
        }

    @property
    def _tolerance(self) -> float:
        return _SAME * self.unit

    def _on_end(self, p: np.ndarray) -> np.ndarray:
        if self.sizes.end_radius is None:
            return self._at(0.0)(p)
        away = np.hypot(p[..., 0] - self.sizes.track_radius, p[..., 1])
        height = self.sizes.sphere(np.minimum(away, self.face))
        return np.all(np.abs(p[..., 2] - height) < self._tolerance, axis=1)

    def _at(self, z: float) -> Claim:
        return lambda p: np.all(np.abs(p[..., 2] - z) < self._tolerance, axis=1)

    def _under_pin(self, p: np.ndarray) -> np.ndarray:
        away = np.hypot(p[..., 0] - self.sizes.track_radius, p[..., 1])
        return np.all(away < self.face + self._tolerance, axis=1)


def _on_radius(radius: float, tolerance: float) -> Claim:
    """Predicate of the facets with all nodes at a distance from the z-axis."""
    return lambda p: np.all(
        np.abs(np.hypot(p[..., 0], p[..., 1]) - radius) < tolerance + 1e-9 * radius, axis=1
    )
