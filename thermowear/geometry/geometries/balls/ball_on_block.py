"""Sphere on a round block, in space.

The contact lies at the origin, the sphere above. Its lower half is meshed and held on the flat at
the height of its centre. Both bodies consist of curved tetrahedra made by gmsh.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np

from ....case.tables.geometry import keyed, named
from ....case.values.pressing import Pressing
from ....case.values.units import Length
from ....errors import CaseError
from ...mesh.tagged import TaggedMesh
from ...meshing.cells import Claim, both, every, tagged_bodies
from ...meshing.tetrahedra import RoundZone
from .ball_geometry import BallGeometry

_FACE = 1.4
"""Radius of the contact faces over that of the expected contact."""
_WIDEST = 0.5
"""Largest radius of the contact faces, by the radius of the sphere and of the block."""
_THINNEST = 1e-4
"""Least contact radius that can be meshed, by the radius of the sphere."""
_COARSEST = 0.4
"""Largest element size, by the radius of the sphere or the smaller dimension of the block."""
_SAME = 1e-7
"""Tolerance for positions of nodes on a surface, by the radius of the sphere."""


class BallOnBlock(BallGeometry):
    """Dimensions of sphere and block.

    ``mesh.elements`` is the number across the expected contact. Elements at its edge are smaller by
    the factor ``mesh.grading``.

    Attributes
    ----------
    block_radius : float
        Radius of the block [m].
    block_height : float
        Height of the block [m].
    zone : float or None
        Radius of the finely meshed zone, by default that of the expected contact of the unworn
        bodies; larger for contacts that grow by wear [m].
    """

    name = "ball-on-block"
    bodies = ("sphere", "block")
    held = "sphere_top"
    fixed = "block_bottom"
    unmeshed = ("zone",)

    type: Literal["ball-on-block"]
    block_radius: Length
    block_height: Length
    zone: Length | None = None

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        on_bodies = *named("sphere", "face", "top"), *named("block", "face", "top", "bottom")
        return *on_bodies, *self.rollers, *named("sphere", "side"), *named("block", "side")

    @property
    def follows_contact(self) -> bool:
        """False: the mesh is refined for the expected contact, but never fitted to its edge."""
        return False

    def expected_zone(self, pressing: Pressing) -> tuple[float, float] | None:
        if pressing.force is not None:  # Hertz
            force = pressing.force * (2 if self.half else 1)
            found = (3 * force * self.radius / (4 * pressing.modulus)) ** (1 / 3)
        else:
            assert pressing.approach is not None
            found = math.sqrt(self.radius * pressing.approach)
        if self.zone is not None and self.zone < found:
            raise CaseError(
                f"geometry.zone: found {self.zone:g} m; must be at least the expected "
                f"radius of the unworn contact, {found:.3g} m"
            )
        radius = found if self.zone is None else self.zone
        return -radius, radius

    def check_zone(self, zone: tuple[float, float]) -> None:
        least, found = _THINNEST * self.radius, zone[1]
        most = _WIDEST * min(self.radius, self.block_radius) / _FACE
        if not least <= found <= most:
            raise CaseError(
                f"geometry.radius: the contact is expected to have a radius of {found:.3g} m; "
                f"it can be meshed from {least:.3g} m to {most:.3g} m"
            )

    def build(self, mesh, zone=None) -> TaggedMesh:
        assert zone is not None
        self.check_zone(zone)
        drawn = _Drawing(self, _FACE * zone[1])
        zones = {body: self._zone(body, mesh, zone[1]) for body in self.bodies}
        bodies = self.meshed(mesh, zones, drawn.drawing)
        bodies["sphere"] = replace(bodies["sphere"], points=drawn.rounded(bodies["sphere"].points))
        claims = drawn.claims()
        found = tagged_bodies(bodies, {surface: claims[surface] for surface in self.surfaces})
        return replace(found, cell_type="tetrahedron")

    def _zone(self, body: str, mesh, radius: float) -> RoundZone:
        """Element sizes of a body for a contact radius [m]."""
        elements, grading = mesh.face(body)
        reach, volume = self.radius, 2 / 3 * math.pi * self.radius**3
        if body == "block":
            reach = min(self.block_radius, self.block_height)
            volume = math.pi * self.block_radius**2 * self.block_height
        inside = 2 * radius / elements
        largest = max(_COARSEST * reach, inside)
        return RoundZone(0.0, radius, inside, grading * inside, largest, volume)


class _Drawing:
    """Drawing of both bodies for gmsh, and the names of their surfaces.

    The sphere is drawn with an end that is flat within the contact face and rounded afterwards:
    both faces can have the same triangles.

    Parameters
    ----------
    sizes : BallOnBlock
    face : float
        Radius of the contact faces [m].
    """

    def __init__(self, sizes: BallOnBlock, face: float):
        self._sizes, self._face = sizes, face
        self._rise = float(self._sphere(np.array(face)))
        self._tolerance = _SAME * sizes.radius

    def drawing(self, names: tuple[str, ...]):
        """Function that draws some of the bodies, lengths by the radius of the sphere."""

        def draw(occ) -> dict[str, list[int]]:
            drawn = [(3, (self._ball if name == "sphere" else self._block)(occ)) for name in names]
            face = self._face / self._sizes.radius
            outline = (2, occ.addDisk(0, 0, 0, face, face))
            if self._sizes.half:
                ((outline, *_), _) = occ.intersect([outline], [self._upper_half(occ)])
            parts = occ.fragment(drawn, [outline])[1]
            return {
                name: [tag for dim, tag in part if dim == 3]
                for name, part in zip(names, parts[: len(names)], strict=True)
            }

        return draw

    def _ball(self, occ) -> int:
        rise = self._rise / self._sizes.radius
        ball = (3, occ.addSphere(0, 0, 1 - rise, 1.0))
        box = occ.addBox(-2, 0 if self._sizes.half else -2, 0, 4, 4, 1 - rise)
        ((_, tag),) = occ.intersect([ball], [(3, box)])[0]
        return tag

    def _block(self, occ) -> int:
        sizes, unit = self._sizes, self._sizes.radius
        height, angle = sizes.block_height / unit, math.pi if sizes.half else 2 * math.pi
        radius = sizes.block_radius / unit
        return occ.addCylinder(0, 0, -height, 0, 0, height, radius, angle=angle)

    def _upper_half(self, occ) -> tuple[int, int]:
        return 2, occ.addRectangle(-2, 0, 0, 4, 2)

    def _sphere(self, away: np.ndarray) -> np.ndarray:
        """Height of the sphere at distances from its axis [m]."""
        radius = self._sizes.radius
        return away**2 / (radius + np.sqrt(radius**2 - away**2))

    def rounded(self, points: np.ndarray) -> np.ndarray:
        """Points of the sphere with its end rounded.

        Nodes of the flat face are moved to the sphere, those above in proportion to their distance
        from the top.
        """
        away = np.hypot(points[:, 0], points[:, 1])
        sphere = self._sphere(np.minimum(away, self._face))
        part = 1 - points[:, 2] / (self._sizes.radius - self._rise)
        result = points.copy()
        result[:, 2] += self._rise - (self._rise - sphere) * part
        return result

    def claims(self) -> dict[str, Claim]:
        """Predicates of all surfaces, see `tagged_bodies`."""
        sizes = self._sizes
        in_middle = self._at(1, 0.0)
        return {
            "sphere_face": both(self._on_end, self._within),
            "sphere_top": self._at(2, sizes.radius),
            "block_face": both(self._at(2, 0.0), self._within),
            "block_top": self._at(2, 0.0),
            "block_bottom": self._at(2, -sizes.block_height),
            "sphere_middle": in_middle,
            "block_middle": in_middle,
            "sphere_side": every,
            "block_side": every,
        }

    def _at(self, axis: int, level: float) -> Claim:
        return lambda p: np.all(np.abs(p[..., axis] - level) < self._tolerance, axis=1)

    def _on_end(self, p: np.ndarray) -> np.ndarray:
        height = self._sphere(np.minimum(np.hypot(p[..., 0], p[..., 1]), self._face))
        return np.all(np.abs(p[..., 2] - height) < self._tolerance, axis=1)

    def _within(self, p: np.ndarray) -> np.ndarray:
        away = np.hypot(p[..., 0], p[..., 1])
        return np.all(away < self._face + self._tolerance, axis=1)
