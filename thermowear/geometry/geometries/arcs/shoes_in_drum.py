"""Drum brake: several shoes with linings in one drum, each on its pivot.

The centre of the drum is the origin (section across the axis). Angles are measured from 12 o'clock
(the direction +y), clockwise: positive towards +x.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Literal

from pydantic import model_validator

from ....case.assembly.geometry import AssemblyGeometry
from ....case.values.section import KeyFault, Section
from ....case.values.units import Angle, Coordinate, Length
from ...checks.assembly_checks import check_drawn
from ...meshing.cells import ORDER, Claim, every, mesh_body, tagged_bodies
from ...meshing.rings import all_round, complete
from .shoe import ORIGIN, Shoe, check_order, degrees

_DRUM = "drum"
_APART = math.radians(1.0)
"""Least angle between two linings."""


class ShoeTable(Section):
    """Place of a shoe.

    Attributes
    ----------
    arc_start : float
        Angle at the first end of its lining, clockwise from 12 o'clock (+y) [rad].
    arc_end : float
        Angle at the other end of its lining, greater than that at the first one [rad].
    pivot : tuple of float
        Centre of its rotation [m].
    """

    arc_start: Angle
    arc_end: Angle
    pivot: tuple[Coordinate, Coordinate]

    @model_validator(mode="after")
    def _ordered(self):
        check_order(self.arc)
        return self

    @property
    def arc(self) -> tuple[float, float]:
        return self.arc_start, self.arc_end


class ShoesInDrum(AssemblyGeometry):
    """Dimensions of a drum and of the shoes in it.

    The bodies are the shoes by their names, and the drum. The surfaces of a shoe are its ``face``,
    ``inside`` and ``side``; those of the drum its ``rim`` and, inside, one named after each shoe
    and the rest ``inside``. The lining of a shoe is the zone ``SHOE_lining``; the contact with the
    drum has the name of the shoe.

    Attributes
    ----------
    drum_radius : float
        Inner radius of the drum, where the linings touch [m].
    drum_thickness : float
        Radial thickness of the drum [m].
    lining_thickness : float
        Radial thickness of the linings [m].
    shoe_thickness : float
        Radial thickness of the shoes [m].
    shoes : dict of str to ShoeTable
        Places of the shoes, by name.
    thickness : float
        Thickness that forces refer to: the width of the shoes [m].
    """

    name = "shoes-in-drum"
    models = ("plane-strain", "plane-stress")

    type: Literal["shoes-in-drum"]
    drum_radius: Length
    drum_thickness: Length
    lining_thickness: Length
    shoe_thickness: Length
    shoes: dict[str, ShoeTable]
    thickness: Length = 1e-3

    @model_validator(mode="after")
    def _fits(self):
        if not self.shoes:
            raise KeyFault("shoes", "missing; needs the places of the shoes: [geometry.shoes.NAME]")
        for name, shoe in self._shoes.items():
            try:
                shoe.check()
            except KeyFault as fault:
                whole = fault.key == "shoe_thickness"
                key = fault.key if whole else f"shoes.{name}.{fault.key}"
                raise KeyFault(key, str(fault)) from None
        self._check_apart()
        for named in ((*self.bodies, *self.zones), self.surfaces):
            if len(set(named)) < len(named):
                raise KeyFault("shoes", "a shoe has a name of the drum, or of a part of another")
        return self

    def _check_apart(self) -> None:
        """Reject linings that overlap."""
        placed = self._clockwise
        around = [*placed.items(), next(iter(placed.items()))]
        for (one, shoe), (other, following) in pairwise(around):
            between = (following.arc[0] - shoe.arc[0]) % (2 * math.pi)
            length = shoe.arc[1] - shoe.arc[0]
            if one != other and between - length < _APART:
                raise KeyFault(
                    f"shoes.{other}.arc_start",
                    f"{degrees(following.arc[0])} is too close to shoes.{one}, which ends at "
                    f"{degrees(shoe.arc[1])}; linings must be {degrees(_APART)} apart",
                )

    @property
    def bodies(self) -> tuple[str, ...]:
        return *self.shoes, _DRUM

    @property
    def surfaces(self) -> tuple[str, ...]:
        return tuple(name for name, _ in self._claims())

    @property
    def zones(self) -> dict[str, str]:  # type: ignore[override]
        return {_lining(name): name for name in self.shoes}

    @property
    def contacts(self) -> dict[str, tuple[str, str]]:
        return {name: (f"{name}_face", f"{_DRUM}_{name}") for name in self.shoes}

    @property
    def thickness_factor(self) -> float | None:  # type: ignore[override]
        return self.thickness

    def press_direction(self, surface: str) -> tuple[float, ...]:
        """Outward direction at the middle of the lining."""
        shoe = self._shoes.get(self.body_of(surface))
        return super().press_direction(surface) if shoe is None else shoe.outward

    def pivot(self, surface: str) -> tuple[float, ...] | None:
        shoe = self.shoes.get(self.body_of(surface))
        return None if shoe is None else shoe.pivot

    def track(self, face: str) -> tuple[str, float] | None:
        """Inner circumference of the drum."""
        return (_DRUM, 2 * math.pi * self.drum_radius) if self.body_of(face) == _DRUM else None

    def check(self, mesh, case):
        check_drawn(mesh, case)

    def build(self, mesh):
        radius, rim = self.drum_radius, self.drum_radius + self.drum_thickness
        bodies = {}
        for name, shoe in self._shoes.items():
            division = complete(shoe.arc, radius, mesh.face(name))
            bodies[name] = mesh_body(shoe.sheets(division, _lining(name)), ORDER)
        inside = [complete(shoe.arc, radius, mesh.face(_DRUM)) for shoe in self._clockwise.values()]
        rows = min(inside, key=lambda face: face.first).rows(radius, rim)
        bodies[_DRUM] = mesh_body([ORIGIN.sheet(all_round(inside), rows)], ORDER)
        return tagged_bodies(bodies, dict(self._claims()))

    @property
    def _shoes(self) -> dict[str, Shoe]:
        layers = self.lining_thickness, self.shoe_thickness
        return {
            name: Shoe(self.drum_radius, table.arc, layers, table.pivot)
            for name, table in self.shoes.items()
        }

    @property
    def _clockwise(self) -> dict[str, Shoe]:
        """Shoes in the order of the starts of their arcs."""
        first = next(iter(self.shoes.values())).arc_start
        ordered = sorted(
            self._shoes.items(), key=lambda item: (item[1].arc[0] - first) % (2 * math.pi)
        )
        return dict(ordered)

    def _claims(self) -> Iterator[tuple[str, Claim]]:
        """Predicates of all surfaces, see `tagged_bodies`."""
        for name, shoe in self._shoes.items():
            yield f"{name}_face", shoe.face()
            yield f"{name}_inside", shoe.inside()
            yield f"{name}_side", every
            yield f"{_DRUM}_{name}", ORIGIN.circle(self.drum_radius, shoe.arc)
        yield f"{_DRUM}_inside", ORIGIN.circle(self.drum_radius)
        yield f"{_DRUM}_rim", ORIGIN.circle(self.drum_radius + self.drum_thickness)


def _lining(shoe: str) -> str:
    return f"{shoe}_lining"
