"""Ball in a spherical socket, in space: ball joints, spherical bearings, hip joints.

The contact starts at the origin, the ball above. Its lower half is meshed and held on the flat at
the height of its centre. Both bodies consist of curved tetrahedra made by gmsh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from ....case.tables.geometry import keyed, named
from ....case.values.section import KeyFault
from ....case.values.units import Angle, Length
from ...mesh.tagged import TaggedMesh
from ...meshing.cells import Claim, both, every, tagged_bodies
from ...meshing.tetrahedra import CELLS_PER_CUBE, GROWTH
from .ball_geometry import BallGeometry

_WIDEST = math.radians(80.0)
"""Largest angle of the socket from the load direction."""
_COARSEST = 0.4
"""Largest element size, by the radius of the ball."""
_SAME = 1e-6
"""Tolerance for positions of nodes on a surface, by the radius of the ball."""


class BallInSocket(BallGeometry):
    """Dimensions of ball and socket.

    ``mesh.elements`` is the number along an arc of the socket from rim to rim. Elements at the rim
    are smaller by the factor ``mesh.grading``.

    Attributes
    ----------
    clearance : float
        Difference of the radii of socket and ball [m].
    socket_angle : float
        Angle between the load direction and the rim of the socket [rad].
    socket_radius : float
        Outer radius of the socket [m].
    socket_thickness : float
        Thickness of the socket below the ball [m].
    """

    name = "ball-in-socket"
    bodies = ("ball", "socket")
    held = "ball_top"
    fixed = "socket_bottom"
    unmeshed = ("clearance",)

    type: Literal["ball-in-socket"]
    clearance: Length
    socket_angle: Annotated[Angle, Field(gt=0.0, le=_WIDEST)]
    socket_radius: Length
    socket_thickness: Length

    @model_validator(mode="after")
    def _fits(self):
        if not self.clearance < 0.5 * self.radius:
            raise KeyFault("clearance", f"found {self.clearance:g} m; at most half of the radius")
        if not self.rim < self.socket_radius:
            raise KeyFault(
                "socket_radius",
                f"found {self.socket_radius:g} m; must be greater than that of the rim of the "
                f"socket, {self.rim:.4g} m",
            )
        return self

    @keyed
    def surfaces(self) -> tuple[str, ...]:
        ball, socket = named("ball", "face", "top"), named("socket", "face", "bottom", "rim")
        return *ball, *socket, *self.rollers, *named("ball", "side"), *named("socket", "side")

    @property
    def rim(self) -> float:
        """Radius of the rim of the socket, without clearance [m]."""
        return self.radius * math.sin(self.socket_angle)

    def bearing_area(self) -> float:
        return math.pi * self.rim**2

    def build(self, mesh, zone=None) -> TaggedMesh:
        zones = {body: self._zone(body, mesh) for body in self.bodies}
        bodies = self.meshed(mesh, zones, self._drawing)
        claims = self._claims()
        found = tagged_bodies(bodies, {surface: claims[surface] for surface in self.surfaces})
        points = found.points.copy()
        points[len(bodies["ball"].points) :] = self._widened(bodies["socket"].points)
        return replace(found, points=points, cell_type="tetrahedron")

    def _widened(self, points: np.ndarray) -> np.ndarray:
        """Points of a socket of the radius of the ball, with the clearance.

        They move away from the centre of the ball, less the farther they are from its surface.
        """
        arms = points - np.array([0.0, 0.0, self.radius])
        away = np.linalg.norm(arms, axis=1)
        up, c = arms[:, 2] / away, self.clearance
        gap = c * up + np.sqrt((self.radius + c) ** 2 - c**2 * (1 - up**2)) - self.radius
        reach = min(self.socket_thickness, self.socket_radius - self.rim)
        part = np.clip(1 - (away - self.radius) / reach, 0.0, 1.0)
        return points + (part * gap / away)[:, None] * arms

    def _zone(self, body: str, mesh) -> CapZone:
        """Element sizes of a body."""
        elements, grading = mesh.face(body)
        inside = 2 * self.radius * self.socket_angle / elements
        volume, reach = 2 / 3 * math.pi * self.radius**3, self.radius
        if body == "socket":
            reach = min(self.socket_radius, self.socket_thickness)
            volume = math.pi * self.socket_radius**2 * (self.socket_thickness + self._rise)
        largest = max(_COARSEST * reach, inside)
        return CapZone(self.radius, self.socket_angle, inside, grading * inside, largest, volume)

    @property
    def _rise(self) -> float:
        """Height of the rim of the socket [m]."""
        return self.radius * (1 - math.cos(self.socket_angle))

    def _drawing(self, names: tuple[str, ...]):
        """Function that draws some of the bodies without clearance, lengths by the radius."""
        unit, turn = self.radius, math.pi if self.half else 2 * math.pi
        south, rim = -math.pi / 2, self.socket_angle - math.pi / 2
        deep, high, radius = (
            x / unit for x in (self.socket_thickness, self._rise, self.socket_radius)
        )

        def ball(occ) -> list[tuple[int, int]]:
            below = occ.addSphere(0, 0, 1, 1, angle1=south, angle2=rim, angle3=turn)
            above = occ.addSphere(0, 0, 1, 1, angle1=rim, angle2=0, angle3=turn)
            return [(3, below), (3, above)]

        def socket(occ) -> list[tuple[int, int]]:
            block = occ.addCylinder(0, 0, -deep, 0, 0, deep + high, radius, angle=turn)
            return occ.cut([(3, block)], [(3, occ.addSphere(0, 0, 1, 1))])[0]

        def draw(occ) -> dict[str, list[int]]:
            drawn = {name: (ball if name == "ball" else socket)(occ) for name in names}
            every = [part for parts in drawn.values() for part in parts]
            pieces = iter(occ.fragment(every, [])[1] if len(every) > 1 else [every])
            return {
                name: [tag for _ in parts for _, tag in next(pieces)]
                for name, parts in drawn.items()
            }

        return draw

    def _claims(self) -> dict[str, Claim]:
        """Predicates of all surfaces, see `tagged_bodies`."""
        in_middle = self._at(1, 0.0)
        return {
            "ball_face": both(self._round, self._below(self._rise)),
            "ball_top": self._at(2, self.radius),
            "socket_face": self._round,
            "socket_rim": self._at(2, self._rise),
            "socket_bottom": self._at(2, -self.socket_thickness),
            "ball_middle": in_middle,
            "socket_middle": in_middle,
            "ball_side": every,
            "socket_side": every,
        }

    def _at(self, axis: int, height: float) -> Claim:
        tolerance = _SAME * self.radius
        return lambda p: np.all(np.abs(p[..., axis] - height) < tolerance, axis=1)

    def _below(self, height: float) -> Claim:
        return lambda p: np.all(p[..., 2] < height + _SAME * self.radius, axis=1)

    def _round(self, p: np.ndarray) -> np.ndarray:
        """Facets on the ball."""
        away = np.linalg.norm(p - np.array([0.0, 0.0, self.radius]), axis=-1)
        return np.all(np.abs(away - self.radius) < _SAME * self.radius, axis=1)


@dataclass(frozen=True)
class CapZone:
    """Element sizes around a contact on a cap of a sphere that touches the origin from above.

    Attributes
    ----------
    radius : float
        Radius of the sphere [m].
    angle : float
        Angle of the cap, from its lowest point to its border [rad].
    inside, edge, largest : float
        Element sizes in the contact, at its border, and far away [m].
    volume : float
        Volume of the body, for an estimate of the number of cells [m³].
    """

    radius: float
    angle: float
    inside: float
    edge: float
    largest: float
    volume: float
    per_turn = 24

    def expressions(self, unit: float) -> tuple[str, str]:
        """Sizes due to the contact and to its edge, as gmsh's ``MathEval``, in a length unit."""
        radius, inside, edge = (f"({v / unit!r})" for v in (self.radius, self.inside, self.edge))
        rim, rise = f"{radius}*{math.sin(self.angle)!r}", f"{radius}*{1 - math.cos(self.angle)!r}"
        beside, above = f"(Sqrt(x*x+y*y)-{rim})", f"(z-{rise})"
        across = f"(Sqrt(x*x+y*y+(z-{radius})*(z-{radius}))-{radius})"
        beyond = f"(0.5*({above}+Fabs({above})))"
        from_face = f"Sqrt({across}*{across}+{beyond}*{beyond})"
        from_edge = f"Sqrt({beside}*{beside}+{above}*{above})"
        return f"{inside}+{GROWTH}*{from_face}", f"{edge}+{GROWTH}*{from_edge}"

    def cells(self) -> float:
        """Estimate of the number of tetrahedra of the body."""
        area = 2 * math.pi * self.radius**2 * (1 - math.cos(self.angle))
        around = 2 * math.pi * self.radius * math.sin(self.angle)
        away = np.geomspace(1e-3 * self.edge, self.radius, 400)
        below = np.trapezoid(1 / np.minimum(self.inside + GROWTH * away, self.largest) ** 3, away)
        near = np.minimum(self.edge + GROWTH * away, self.inside) ** -3 - self.inside**-3
        edges = np.trapezoid(math.pi * away * near, away)
        surface = 1 / self.inside**2 + below
        return CELLS_PER_CUBE * (
            area * surface + around * max(edges, 0.0) + self.volume / self.largest**3
        )
