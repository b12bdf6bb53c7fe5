"""Tube held between several supports, each with a larger radius (section across the tube).

The centre of the tube is the origin. Angles are measured from 12 o'clock (the direction +y),
clockwise: positive towards +x.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Literal

from pydantic import model_validator

from ....case.assembly.geometry import AssemblyGeometry
from ....case.values.section import KeyFault, Section
from ....case.values.units import Angle, Length
from ...checks.assembly_checks import check_drawn
from ...meshing.cells import ORDER, Claim, every, mesh_body, tagged_bodies
from ...meshing.rings import Division, Polar, all_round
from .in_hole import InHole, check_arc
from .shoe import ORIGIN, degrees

_TUBE = "tube"
_APART = math.radians(1.0)
"""Least angle between two supports."""


class SupportTable(Section):
    """Place of a support.

    Attributes
    ----------
    angle : float
        Angle at the middle of its contact, clockwise from 12 o'clock (+y) [rad].
    clearance : float or None
        Radius of its face minus that of the tube, by default the `support_clearance` [m].
    """

    angle: Angle
    clearance: Length | None = None


class TubeBetweenSupports(AssemblyGeometry):
    """Dimensions of a tube and of the supports around it.

    The bodies are the supports by their names, and the tube. The surfaces of a support are its
    ``face``, beside it ``hole``, ``rim`` at its back and ``side``; those of the tube one named
    after each support, the rest ``outside``, and ``bore``. The contact with the tube has the name
    of the support.

    Attributes
    ----------
    tube_radius : float
        Outer radius of the tube [m].
    tube_wall : float
        Wall thickness of the tube [m].
    support_clearance : float
        Radius of a support's face minus that of the tube [m].
    support_thickness : float
        Radial thickness of the supports [m].
    support_arc : float
        Angle that each support covers, with the contact in the middle [rad].
    zone : float
        Half-width of the fine mesh of each contact [m].
    supports : dict of str to SupportTable
        Places of the supports, by name.
    thickness : float
        Thickness that forces refer to: the length of the supports along the tube [m].
    """

    name = "tube-between-supports"
    models = ("plane-strain", "plane-stress")

    type: Literal["tube-between-supports"]
    tube_radius: Length
    tube_wall: Length
    support_clearance: Length
    support_thickness: Length
    support_arc: Angle
    zone: Length
    supports: dict[str, SupportTable]
    thickness: Length = 1e-3

    @model_validator(mode="after")
    def _fits(self):
        if not self.supports:
            text = "missing; needs the places of the supports: [geometry.supports.NAME]"
            raise KeyFault("supports", text)
        if not self.tube_wall < self.tube_radius:
            text = f"{self.tube_wall:g} m must be less than tube_radius {self.tube_radius:g} m"
            raise KeyFault("tube_wall", text)
        check_arc("support_arc", self.support_arc)
        for drawing in self._drawings.values():
            if not self.zone <= drawing.farthest:
                raise KeyFault(
                    "zone",
                    f"{self.zone:g} m is too large for this support_arc; must be at most "
                    f"{drawing.farthest:.3g} m",
                )
        self._check_apart()
        for named in (self.bodies, self.surfaces):
            if len(set(named)) < len(named):
                raise KeyFault("supports", "a support has a name of the tube, or of a part of it")
        return self

    def _check_apart(self) -> None:
        """Reject supports that overlap."""
        around = [*self._clockwise, self._clockwise[0]]
        for one, other in pairwise(around):
            between = (self.supports[other].angle - self.supports[one].angle) % (2 * math.pi)
            if one != other and between - self.support_arc < _APART:
                raise KeyFault(
                    f"supports.{other}.angle",
                    f"{degrees(self.supports[other].angle)} is too close to supports.{one} at "
                    f"{degrees(self.supports[one].angle)}; supports "
                    f"of {degrees(self.support_arc)} must be {degrees(_APART)} apart",
                )

    @property
    def bodies(self) -> tuple[str, ...]:
        return *self.supports, _TUBE

    @property
    def surfaces(self) -> tuple[str, ...]:
        return tuple(name for name, _ in self._claims())

    @property
    def contacts(self) -> dict[str, tuple[str, str]]:
        return {name: (f"{_TUBE}_{name}", f"{name}_face") for name in self.supports}

    @property
    def thickness_factor(self) -> float | None:  # type: ignore[override]
        return self.thickness

    def press_direction(self, surface: str) -> tuple[float, ...]:
        """Direction of a support towards the tube; of the tube towards the first support."""
        body = self.body_of(surface)
        inwards = body in self.supports
        angle = self.supports[body if inwards else next(iter(self.supports))].angle
        out = math.sin(angle), math.cos(angle)
        return (-out[0], -out[1]) if inwards else out

    def check(self, mesh, case):
        check_drawn(mesh, case)

    def build(self, mesh):
        drawings, tube = self._drawings, mesh.face(_TUBE)
        zone = -self.zone, self.zone
        faces = {name: each.faces(zone, tube, mesh.face(name)) for name, each in drawings.items()}
        on_tube = [faces[name][0].turned(self.supports[name].angle) for name in self._clockwise]
        first = next(iter(drawings.values()))
        rows = on_tube[0].rows(first.radius, first.bore)
        bodies = {}
        for name, drawing in drawings.items():
            face = faces[name][1]
            angles = drawing.around(face) + self.supports[name].angle
            sheet = self._centre(name).sheet(angles, face.rows(drawing.hole, drawing.rim))
            bodies[name] = mesh_body([sheet], ORDER)
        bodies[_TUBE] = mesh_body([ORIGIN.sheet(all_round(on_tube), rows)], ORDER)
        return tagged_bodies(bodies, dict(self._claims(faces)))

    @property
    def _drawings(self) -> dict[str, InHole]:
        """Tube with each of its supports."""
        return {
            name: InHole(
                self.tube_radius,
                self.tube_wall,
                table.clearance or self.support_clearance,
                self.support_thickness,
                self.support_arc,
            )
            for name, table in self.supports.items()
        }

    @property
    def _clockwise(self) -> list[str]:
        """Supports in the order of their angles, from the first one on."""
        first = next(iter(self.supports.values())).angle
        return sorted(
            self.supports, key=lambda name: (self.supports[name].angle - first) % (2 * math.pi)
        )

    def _centre(self, support: str) -> Polar:
        """Coordinates about the centre of the face of a support that touches the tube."""
        angle, clearance = self.supports[support].angle, self._drawings[support].clearance
        return Polar(-clearance * math.cos(angle), x=-clearance * math.sin(angle))

    def _claims(
        self, faces: dict[str, tuple[Division, Division]] | None = None
    ) -> Iterator[tuple[str, Claim]]:
        """Predicates of all surfaces for the divisions of both faces of each contact."""
        for name, drawing in self._drawings.items():
            angle, centre = self.supports[name].angle, self._centre(name)
            on_tube, on_support = (
                None if faces is None else faces[name][body].turned(angle).span for body in (0, 1)
            )
            yield f"{name}_face", centre.circle(drawing.hole, on_support)
            yield f"{name}_hole", centre.circle(drawing.hole)
            yield f"{name}_rim", centre.circle(drawing.rim)
            yield f"{name}_side", every
            yield f"{_TUBE}_{name}", ORIGIN.circle(drawing.radius, on_tube)
        yield f"{_TUBE}_outside", ORIGIN.circle(self.tube_radius)
        yield f"{_TUBE}_bore", ORIGIN.circle(self.tube_radius - self.tube_wall)
