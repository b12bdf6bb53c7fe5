"""The tables and keys of a case file.

Everything here is in SI once it is read; the unit of each key stands in `units`.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from ..errors import CaseError
from . import units
from .analyses import Fretting, Initial, Reciprocating, Steady, Transient
from .checks import check
from .geometry import AnyGeometry, Pressing
from .history import History
from .materials import Body, resolve_like
from .section import KeyFault, Number, Section, Switch
from .wear import Wear

Fraction = Annotated[Number, Field(ge=0.0, le=1.0)]
Elements = Annotated[int, Field(ge=1, le=2000, strict=True)]
Grading = Annotated[Number, Field(ge=0.05, le=1.0)]


def _pressure_degree(value: Any) -> Any:
    whole = isinstance(value, int) and not isinstance(value, bool)
    if value is None or value == "lobatto" or (whole and 1 <= value <= 10):
        return value
    raise ValueError(f'found {value!r}; must be a whole number from 1 to 10, or "lobatto"')


def _variant(value: Any) -> Any:
    if isinstance(value, bool | float):  # equal to 1 in Python, but not what was asked for
        raise ValueError(f"found {value!r}; must be 1, 0 or -1")
    return value


FreeMotion = Literal["x", "y", "z", "rotation", "rotation-x", "rotation-y"]
PressureDegree = Annotated[int | Literal["lobatto"] | None, BeforeValidator(_pressure_degree)]
Variant = Annotated[Literal[1, 0, -1] | None, BeforeValidator(_variant)]


class FaceMesh(Section):
    """How the contact face of one body is divided where it differs from the other's."""

    elements: Elements | None = None
    grading: Grading | None = None


class Mesh(Section):
    """Discretisation.

    Attributes
    ----------
    degree : int
        Polynomial degree of displacement and temperature.
    elements : int
        Elements along the contact.
    grading : float
        Size ratio of neighbouring elements towards the contact edges.
    bodies : dict of str to FaceMesh
        Differences of single bodies: faces need not match.
    """

    degree: Annotated[int, Field(ge=1, le=10, strict=True)] = 8
    elements: Elements = 12
    grading: Grading = 0.3
    bodies: dict[str, FaceMesh] = {}

    def face(self, body: str) -> tuple[int, float]:
        """Elements along the contact and grading of one body."""
        own = self.bodies.get(body, FaceMesh())
        return own.elements or self.elements, own.grading or self.grading


class Holder(Section):
    """How body 1 is held.

    Attributes
    ----------
    free : tuple of str
        Motions it may make under its loads, or is given: ``"z"`` along the press, ``"x"`` (and
        ``"y"``) across it, ``"rotation"`` in the section, ``"rotation-x"`` and ``"rotation-y"`` in
        space.
    pivot : tuple of float or None
        Point about which it turns, by default that of the geometry, or the origin [m].
    """

    free: tuple[FreeMotion, ...] = ("z",)
    pivot: tuple[units.Coordinate, ...] | None = None

    @model_validator(mode="after")
    def _once(self):
        if len(set(self.free)) != len(self.free):
            raise KeyFault("free", "names a motion twice")
        return self

    @property
    def turns(self) -> bool:
        return any(name.startswith("rotation") for name in self.free)


class Load(Section):
    """What presses body 1 on body 2.

    Exactly one of force, mean pressure and approach; a holder that only turns may have a moment
    instead, and one that is fixed needs forces on surfaces.

    Attributes
    ----------
    mean_pressure : float or None
        On the nominal contact area [Pa].
    force : float or None
        Of the whole ring, or of the thickness, along the press [N].
    approach : float or None
        How far the holder moves along the press from where it stands in the mesh [m].
    lever : float or None
        Distance along x from the pivot to the line of the force [m].
    point : tuple of float or None
        Where the force acts: x, or x and y in space, by default at the pivot [m].
    moment : float or None
        About the pivot, in addition [N m]: positive where it presses if the holder only turns,
        anticlockwise otherwise.
    moments : tuple of float or None
        About x and y through the pivot, in space, by the right-hand rule [N m].
    tangential_force : float or None
        Along x, for a holder that is free along it [N].
    surfaces : dict of str to float
        Forces along the press, spread evenly over surfaces of body 1, whose holder is fixed [N].
    history : History or None
        What changes, for a fretting analysis.
    """

    mean_pressure: units.Pressure | None = None
    force: units.Force | None = None
    approach: units.Length | None = None
    lever: units.Coordinate | None = None
    point: tuple[units.Coordinate, ...] | None = None
    moment: units.SignedMoment | None = None
    moments: tuple[units.SignedMoment, units.SignedMoment] | None = None
    tangential_force: units.SignedForce | None = None
    surfaces: dict[str, units.Force] = {}
    history: History | None = None


class Motion(Section):
    """Sliding.

    Attributes
    ----------
    angular_velocity : float or None
        Of body 1 about the axis of an axisymmetric model; of a disk or drum (body 2) about its
        centre, anticlockwise, in plane models and seen from above in space [rad/s].
    velocity : float or None
        Of body 1 over body 2 along x; negative: against it [m/s].
    amplitude, frequency : float or None
        Body 1 slides to and fro, ``x = amplitude sin(2 π frequency t)`` [m, Hz].
    """

    angular_velocity: units.AngularVelocity | None = None
    velocity: units.Velocity | None = None
    amplitude: units.Length | None = None
    frequency: units.Frequency | None = None

    @property
    def one_way(self) -> Motion:
        """The same, with the mean speed of sliding to and fro as a velocity along +x."""
        if self.amplitude is None or self.frequency is None:
            return self
        return self.model_copy(update={"velocity": 4 * self.amplitude * self.frequency})


class Contact(Section):
    """The interface.

    Attributes
    ----------
    friction : float
        Coefficient of friction in the direction of sliding.
    transverse_friction : float
        Coefficient of friction across it, on faces that are not level (Páczelt and Mróz's mu_d).
    compliance : float or None
        Of a soft layer between the faces: how far a pressure presses it together [m/Pa].
    method : str
        ``"condensed"``: the bodies condensed to the interface; ``"penalty"`` and ``"nitsche"`` on
        the full system.
    pressure_degree : int or str or None
        Of the pressure space, by default one below the displacement; ``"lobatto"``: point by point.
    penalty : float or None
        Pressure per penetration of the penalty method, by default from the mesh [Pa/m].
    theta : int or None
        Variant of Nitsche's method: 1 symmetric (default), 0 incomplete, -1 skew-symmetric.
    gamma : float or None
        Stabilisation of Nitsche's method, times ``E degree² / h``.
    positioning : bool
        Move the mesh until element ends lie at the edges of the contact.
    """

    friction: Annotated[Number, Field(ge=0.0)] = 0.0
    transverse_friction: Annotated[Number, Field(ge=0.0)] = 0.0
    compliance: units.Compliance | None = None
    method: Literal["condensed", "penalty", "nitsche"] = "condensed"
    pressure_degree: PressureDegree = None
    penalty: units.Foundation | None = None
    theta: Variant = None
    gamma: Annotated[Number, Field(gt=0.0)] | None = None
    positioning: Switch = False


class Heat(Section):
    """Friction heat.

    Attributes
    ----------
    conductance : float or None
        Contact conductance [W/(m² K)]; None: perfect contact.
    partition : float
        Part of the friction heat that is set free on body 1.
    ambient : float
        Temperature of the surroundings, and of the stress-free state [K].
    cooling : dict of str to float
        Heat transfer coefficients of named surfaces [W/(m² K)].
    temperature : dict of str to float
        Given temperatures of named surfaces [K].
    """

    conductance: units.HeatTransfer | None = None
    partition: Fraction = 0.5
    ambient: units.Temperature = 293.15
    cooling: dict[str, units.HeatTransfer] = {}
    temperature: dict[str, units.Temperature] = {}


class Case(Section):
    """A complete case: what to compute, of which bodies, under which load."""

    title: str = ""
    model: Literal["axisymmetric", "plane-strain", "plane-stress", "3d"]
    geometry: AnyGeometry
    mesh: Mesh = Mesh()
    bodies: dict[str, Body]
    holder: Holder = Holder()
    load: Load
    motion: Motion | None = None
    contact: Contact = Contact()
    wear: dict[str, Wear] = {}
    heat: Heat | None = None
    analysis: Annotated[
        Initial | Steady | Transient | Fretting | Reciprocating, Field(discriminator="type")
    ]

    @model_validator(mode="after")
    def _consistent(self):
        check(self)
        return self

    def force(self) -> float | None:
        """Normal force on body 1 [N], the largest of a history; None under a given approach."""
        history = self.load.history
        if history is not None and history.force is not None:
            return max(history.force)
        area = self.geometry.contact_area()
        if self.load.mean_pressure is not None and area is not None:
            return self.load.mean_pressure * area
        return self.load.force

    def approach(self) -> float | None:
        """Given approach of the holder [m], the largest of a history."""
        history = self.load.history
        if history is not None and history.approach is not None:
            return max(history.approach)
        return self.load.approach

    def pressing(self) -> Pressing:
        """How hard the bodies are pressed together, for estimates."""
        softness = 0.0
        for name in self.geometry.bodies:
            body = self.material(name)
            assert body.young_modulus is not None  # the case has been checked
            assert body.poisson_ratio is not None
            softness += (1 - body.poisson_ratio**2) / body.young_modulus
        return Pressing(self.force(), self.approach(), 1 / softness)

    def tagged_mesh(self, zone: tuple[float, float] | None = None):
        """The mesh of the case, made for a contact zone (by default the expected one).

        Parameters
        ----------
        zone : tuple of float, optional
            Range of x [m].
        """
        if zone is None:
            zone = self.geometry.expected_zone(self.pressing())
        mesh = self.geometry.build(self.mesh, zone)
        x = mesh.points[:, 0]
        if self.model == "axisymmetric" and x.min() < -1e-9 * x.max():
            raise CaseError("geometry: x is the radius of an axisymmetric mesh, found x < 0")
        return mesh

    def material(self, part: str) -> Body:
        """The material of a body, ``like`` followed to its end; a zone may have its body's."""
        given = part if part in self.bodies else self.geometry.zones[part]
        return self.bodies[resolve_like(self.bodies, given)]


def as_plain(case: Case) -> dict[str, Any]:
    """The case as nested tables of text and numbers, every default written out."""
    return case.model_dump(exclude_none=True)
