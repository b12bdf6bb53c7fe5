"""The tables and keys of a case file.

Everything here is in SI once it is read; the unit of each key stands in `units`.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from ...errors import CaseError, quoted
from ..values import units
from ..values.section import Number, Section, Switch
from .analyses import Fretting, Initial, Reciprocating, Stability, Steady, Transient
from .conductance import PressureConductance, TabulatedConductance, harmonic_mean
from .driving import Holder, Load, Motion
from .facing import Facing
from .geometry import Pressing
from .geometry_type import AnyGeometry
from .heat import Heat
from .history import Course, FactorHistory
from .materials import Body, Properties, material_of
from .multipliers import Factors
from .wear import WearTable

Fraction = Annotated[Number, Field(ge=0.0, le=1.0)]
_MOST_NODES = 2_000_000
"""Of displacement: their matrices fill the memory of today's workstations."""

Elements = Annotated[int, Field(ge=1, le=2000, strict=True)]
Grading = Annotated[Number, Field(ge=0.05, le=1.0)]


def _pressure_degree(value: Any) -> Any:
    whole = isinstance(value, int) and not isinstance(value, bool)
    if value is None or value == "lobatto" or (whole and 1 <= value <= 10):
        return value
    raise ValueError(f'found {quoted(value)}; must be a whole number from 1 to 10, or "lobatto"')


def _variant(value: Any) -> Any:
    if isinstance(value, bool | float):  # equal to 1 in Python, but not what was asked for
        raise ValueError(f"found {quoted(value)}; must be 1, 0 or -1")
    return value


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


class Contact(Section):
    """The interface.

    Attributes
    ----------
    friction : float
        Coefficient of friction in the direction of sliding.
    friction_factor : Factors
        Of it, by the mean temperature of both faces, pressure and speed.
    friction_history : FactorHistory or None
        How the friction of a transient analysis changes in time, by a factor.
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
    friction_factor: Factors = Factors()
    friction_history: FactorHistory | None = None
    transverse_friction: Annotated[Number, Field(ge=0.0)] = 0.0
    compliance: units.Compliance | None = None
    method: Literal["condensed", "penalty", "nitsche"] = "condensed"
    pressure_degree: PressureDegree = None
    penalty: units.Foundation | None = None
    theta: Variant = None
    gamma: Annotated[Number, Field(gt=0.0)] | None = None
    positioning: Switch = False


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
    wear: WearTable = WearTable()
    heat: Heat | None = None
    analysis: Annotated[
        Initial | Steady | Transient | Fretting | Reciprocating | Stability,
        Field(discriminator="type"),
    ]

    @model_validator(mode="after")
    def _cell_sets_as_parts(self):
        sets = {name: tuple(body.materials) for name, body in self.bodies.items() if body.materials}
        if sets:
            object.__setattr__(self, "geometry", self.geometry.with_cell_sets(sets))
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

    @property
    def cycles(self) -> float | None:
        """Number of cycles of the loads or of the motion; None where none is given."""
        in_analysis = getattr(self.analysis, "cycles", None)
        return self.wear.cycles if in_analysis is None else in_analysis

    @property
    def histories(self) -> dict[str, Course]:
        """What changes in time, by the path of its key."""
        found: dict[str, Course | None] = {
            "load.history": self.load.history,
            "motion.history": None if self.motion is None else self.motion.history,
            "contact.friction_history": self.contact.friction_history,
        }
        if self.heat is not None:
            found |= {f"heat.{key}": course for key, course in self.heat.histories.items()}
        return {key: course for key, course in found.items() if course is not None}

    @property
    def friction_varies(self) -> bool:
        """Whether the coefficient of friction depends on time, temperature, pressure or speed."""
        contact = self.contact
        return bool(contact.friction_factor.depends_on) or contact.friction_history is not None

    @property
    def varies(self) -> bool:
        """Whether friction, wear or conductance depend on temperature, pressure or speed."""
        tables = (self.contact.friction_factor, *(law.factor for law in self.wear.values()))
        conductance = None if self.heat is None else self.heat.conductance
        return isinstance(conductance, Section) or any(table.depends_on for table in tables)

    def partition(self, facing: Facing) -> float | np.ndarray:
        """Part of the friction heat that is set free on body 1, at points (n,) or everywhere."""
        assert self.heat is not None
        share = self.heat.partition
        if isinstance(share, float):
            return share
        e1, e2 = facing.of(self.located_material, "effusivity")
        return e1 / (e1 + e2)

    def conductance(self, pressure: np.ndarray, facing: Facing) -> np.ndarray | None:
        """Contact conductance at points [W/(m² K)]; None: perfect contact.

        Parameters
        ----------
        pressure : ndarray, shape (n,)
            [Pa]
        facing : Facing
            Parts that touch there.
        """
        assert self.heat is not None
        given = self.heat.conductance
        if isinstance(given, TabulatedConductance):
            return given.value(pressure)
        if isinstance(given, PressureConductance):
            k, hardness = (
                harmonic_mean(*facing.of(self.located_material, key))
                for key in ("conductivity", "hardness")
            )
            return given.value(pressure, k, hardness)
        return None if given is None else np.full(np.shape(pressure), given)

    def tagged_mesh(self, zone: tuple[float, float] | None = None):
        """The mesh of the case, made for a contact zone (by default the expected one).

        Parameters
        ----------
        zone : tuple of float, optional
            Range of x [m].

        Raises
        ------
        CaseError
            If it has more nodes than can be computed, or lies beyond the axis.
        """
        if zone is None:
            zone = self.geometry.expected_zone(self.pressing())
        mesh = self.geometry.build(self.mesh, zone)
        nodes = len(mesh.cells) * self.mesh.degree ** mesh.points.shape[1]
        if nodes > _MOST_NODES:
            raise CaseError(
                f"mesh: {len(mesh.cells)} cells of degree {self.mesh.degree} have about "
                f"{nodes / 1e6:.2g} million nodes, at most {_MOST_NODES / 1e6:g} million can be "
                "computed; look for a slip in a unit of the geometry, or lower mesh.elements or "
                "mesh.degree"
            )
        x = mesh.points[:, 0]
        if self.model == "axisymmetric" and x.min() < -1e-9 * x.max():
            raise CaseError("geometry: x is the radius of an axisymmetric mesh, found x < 0")
        self.geometry.check(mesh, self)
        return mesh

    def material(self, part: str) -> Properties:
        """The material of a part, ``like`` followed to its end; a zone may have its body's."""
        return self.located_material(part)[1]

    def located_material(self, part: str) -> tuple[str, Properties]:
        """Key's path of the table that has the material of a part, and that material.

        Raises
        ------
        ValueError
            If ``like`` names no body, or comes back to itself.
        """
        return material_of(self.geometry, self.bodies, part)


def as_plain(case: Case) -> dict[str, Any]:
    """The case as nested tables of text and numbers, every default written out."""
    return case.model_dump(exclude_none=True)
