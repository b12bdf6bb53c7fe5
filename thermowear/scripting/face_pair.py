"""Interface of two bodies on users' meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from ..case.values import units
from ..case.values.regions import region
from ..errors import CaseError
from ..laws.expressions import Region
from ..laws.histories import TimeFunction
from ..model.conditions import Motion
from ..model.face_wear import CompositeWear, FaceWear, Wear
from ..model.interface import ContactMethod, HardnessConductance, Interface
from .body import BodySurface, MeshBody, require_surface
from .conversion import coefficient_law, number, place_function, quantities, rate_law


@dataclass(frozen=True, eq=False)
class FacePair:
    """Interface of two bodies.

    Attributes
    ----------
    one, other : BodySurface
        Contact faces, in any order.
    friction : float, str, InterfaceLaw or callable
        Coefficient of friction: a number, an expression, a law, or a function of some of p, v, T.
    conductance : float, str, InterfaceLaw, callable, HardnessConductance or None
        Contact conductance likewise; None: perfect contact [W/(m² K)].
    wear : mapping of MeshBody to (str, Law, callable, FaceWear, or mapping to these)
        Wear rates of the bodies, also as functions of some of p, v, T, depth, mu [m/s]; of a body
        of several materials also by cell tag: a law for each one on its contact face; or by region,
        ``{"x < 30 mm": …, "x > 30 mm": …}``.
    partition : float or str
        Fraction of the friction heat released into the body of `one`; ``"effusivity"``: by the
        thermal effusivities of both.
    gap_conductance, compliance, transverse_friction, pressure_degree, method
        See `model.interface.Interface`.
    fluid_pressure : float, str, callable or None
        Pressure of a fluid on both faces, touching or open: a number, an expression, or a function
        of some of x, y, z, r [Pa].
    friction_history : TimeFunction or None
        Time-dependent factor of the friction.
    name : str
        Name in the results of a model of several interfaces, by default of both bodies.
    """

    one: BodySurface
    other: BodySurface
    friction: Any = 0.0
    conductance: Any = None
    wear: Mapping[MeshBody, Any] = field(default_factory=dict)
    gap_conductance: Any = 0.0
    partition: float | Literal["effusivity"] = 0.5
    compliance: Any = 0.0
    fluid_pressure: Any = None
    transverse_friction: float = 0.0
    friction_history: TimeFunction | None = None
    pressure_degree: int | Literal["lobatto"] | None = None
    method: ContactMethod = field(default_factory=ContactMethod)
    name: str = ""

    def __post_init__(self):
        for face in self.faces:
            require_surface(face, "Interface")

    @property
    def faces(self) -> tuple[BodySurface, BodySurface]:
        """Contact faces."""
        return self.one, self.other

    def in_model(
        self,
        bodies: Sequence[MeshBody],
        faces: tuple[BodySurface, BodySurface],
        motion: Motion,
        closes_by_wear: bool,
    ) -> Interface:
        """Interface of a model.

        Parameters
        ----------
        bodies : sequence of MeshBody
            Bodies of the model.
        faces : tuple of BodySurface
            The contact faces, that of the first body of the interface first.
        motion : Motion
            Sliding of the first body over the second one.
        closes_by_wear : bool
        """
        given = self.conductance
        if given is not None and not isinstance(given, HardnessConductance):
            given = coefficient_law(given, "Interface.conductance", "W/(m^2 K)", least=0.0)
        first, second = faces
        own = first.body, second.body
        unknown = [body for body in self.wear if body not in own]
        if unknown:
            raise CaseError(f"Interface.wear: {unknown[0]!r} is no body of this interface")
        wear = {own.index(body): _body_wear(law, body) for body, law in self.wear.items()}
        kinds = {"gap_conductance": units.LeastHeatTransfer, "compliance": units.Compliance}
        kept = ("gap_conductance", "friction_history", "pressure_degree", "method")
        settings = {key: getattr(self, key) for key in kept}
        if self.compliance:
            settings["compliance"] = self.compliance
        return Interface(
            faces=(first.name, second.name),
            bodies=(bodies.index(first.body), bodies.index(second.body)),
            name=self.name or f"{first.body.name}-{second.body.name}",
            motion=motion,
            friction=coefficient_law(self.friction, "Interface.friction", "", least=-np.inf),
            transverse_friction=number(self.transverse_friction, "Interface.transverse_friction"),
            conductance=given,
            partition=self._into_body_1(first),
            fluid_pressure=place_function(self.fluid_pressure, "Interface.fluid_pressure"),
            wear=dict(sorted(wear.items())),
            closes_by_wear=closes_by_wear,
            **quantities("Interface", kinds, settings),
        )

    def _into_body_1(self, first: BodySurface) -> float | Literal["effusivity"]:
        """Fraction of the friction heat released into the first body."""
        if self.partition == "effusivity":
            return "effusivity"
        into_one = number(self.partition, "Interface.partition", 0.0, 1.0)
        return into_one if first is self.one else 1.0 - into_one


def _body_wear(given: Any, body: MeshBody) -> Wear:
    """Wear of a body by one law, or by those of its materials."""
    where = f"Interface.wear of {body.name!r}"
    if isinstance(given, CompositeWear):
        return given
    if not isinstance(given, Mapping):
        return _face_wear(given, where)
    parts, regions = {}, {}
    for tag, law in given.items():
        which = f"{where}, {'region' if isinstance(tag, str) else 'tag'} {tag}"
        if not isinstance(tag, str) and tag not in body.part_of_tag:
            known = ", ".join(map(str, body.part_of_tag)) or "none, the body has one material"
            raise CaseError(f"{where}: unknown cell tag {tag!r}; known: {known}")
        wear = _face_wear(law, which)
        if not wear.in_place or wear.has_layers:
            raise CaseError(f"{which}: must wear in place, without layers")
        if isinstance(tag, str):
            regions[tag] = _region(tag, where), wear
        else:
            parts[body.part_of_tag[tag]] = wear
    return CompositeWear(parts, regions)


def _region(text: str, where: str) -> Region:
    try:
        return region(text)
    except ValueError as error:
        raise CaseError(f"{where}: {error}") from None


def _face_wear(given: Any, where: str) -> FaceWear:
    return given if isinstance(given, FaceWear) else FaceWear(rate_law(given, where))
