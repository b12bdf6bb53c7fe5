"""Tables and keys of a case file.

All values are in SI after reading; `units` defines the unit of each key.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from ...errors import CaseError
from ...laws.histories import LoadHistories
from ..studies.calibration import CalibrationTable
from ..studies.study import StudyTable
from ..values.pressing import Pressing, resolving
from ..values.section import Section
from .analyses import Fretting, Initial, Reciprocating, Stability, Steady, Transient
from .conditions import HeatTable, HolderTable, LoadTable, MotionTable
from .contact import ContactTable, InterfaceTable
from .geometry_choice import AnyGeometry
from .materials import (
    BodyTable,
    Properties,
    cell_sets,
    contact_modulus,
    located_material,
    part_named,
)
from .mesh import MeshTable, check_size
from .probes import ProbeTable
from .tabulated import TimeHistory
from .wear import WearTable


class Case(Section):
    """Complete case: model, bodies, loads, analysis.

    Attributes
    ----------
    title : str
        Heading of pictures and of the report.
    model : str
        Geometric model: an axisymmetric half section, a plane section in plane strain or plane
        stress, or bodies in space.
    geometry : Geometry
        Shape of the bodies, or the file with their mesh or CAD model; its ``type`` selects the
        keys.
    mesh : MeshTable
        Discretisation.
    bodies : dict of str to BodyTable
        Material of each body, by its name in the geometry.
    holder : HolderTable
        Holder of body 1: its free rigid motions.
    load : LoadTable
        Loads that press body 1 on body 2.
    motion : MotionTable or None
        Sliding motion; without it the faces rest on each other.
    contact : ContactTable
        Friction, and the solver of the contact.
    wear : WearTable
        Wear laws by body; bodies without one do not wear.
    heat : HeatTable or None
        Friction heat and thermal boundary conditions; without it the model is isothermal.
    probes : dict of str to ProbeTable
        Points whose temperature is recorded, by name.
    analysis : Section
        What is computed; its ``type`` selects the keys.
    calibrate : CalibrationTable or None
        Parameters to be found from measurements, for the command ``calibrate``.
    study : StudyTable or None
        Uncertain inputs, for the command ``study``.
    """

    title: str = ""
    model: Literal["axisymmetric", "plane-strain", "plane-stress", "3d"]
    geometry: AnyGeometry
    mesh: MeshTable = MeshTable()
    bodies: dict[str, BodyTable]
    holder: HolderTable = HolderTable()
    load: LoadTable
    motion: MotionTable | None = None
    contact: ContactTable = ContactTable()
    wear: WearTable = WearTable()
    heat: HeatTable | None = None
    probes: dict[str, ProbeTable] = {}
    analysis: Annotated[
        Initial | Steady | Transient | Fretting | Reciprocating | Stability,
        Field(discriminator="type"),
    ]
    calibrate: CalibrationTable | None = None
    study: StudyTable | None = None

    @model_validator(mode="after")
    def _cell_sets_as_parts(self):
        sets = cell_sets(self.bodies, self.wear)
        if sets:
            object.__setattr__(self, "geometry", self.geometry.with_cell_sets(sets))
        return self

    def force(self) -> float | None:
        """Normal force on body 1 [N], the maximum of a history; None if the approach is given."""
        history = self.load.history
        if history is not None and history.force is not None:
            return max(history.force)
        area = None if self.load.mean_pressure is None else self.geometry.contact_area()
        if self.load.mean_pressure is not None and area is not None:
            return self.load.mean_pressure * area
        return self.load.force

    def approach(self) -> float | None:
        """Prescribed approach of the holder [m], the maximum of a history."""
        history = self.load.history
        if history is not None and history.approach is not None:
            return max(history.approach)
        return self.load.approach

    def pressing(self) -> Pressing:
        """Normal load and contact modulus, for estimates of the contact zone."""
        modulus = contact_modulus(self.material(name) for name in self.geometry.bodies)
        return Pressing(self.force(), self.approach(), modulus)

    @property
    def meshed_geometry(self) -> AnyGeometry:
        """Geometry with what its mesh follows from."""
        return resolving(self, lambda: (self.pressing(),))

    @property
    def cycles(self) -> float | None:
        """Number of cycles of the loads or of the motion; None if none is given."""
        in_analysis = getattr(self.analysis, "cycles", None)
        return self.wear.cycles if in_analysis is None else in_analysis

    @property
    def contact_tables(self) -> dict[str, InterfaceTable]:
        """Tables of the contacts by their path."""
        return {"contact": self.contact}

    @property
    def reciprocation(self) -> tuple[float, float] | None:
        """Amplitude [m] and frequency [Hz] of a reciprocating motion; None without one."""
        motion = self.motion
        if motion is None or motion.amplitude is None or motion.frequency is None:
            return None
        return motion.amplitude, motion.frequency

    @property
    def load_histories(self) -> LoadHistories:
        """Load history of the holder, if it has one."""
        history = self.load.history
        return LoadHistories(() if history is None else (history.loads,))

    @property
    def histories(self) -> dict[str, TimeHistory]:
        """Time histories by the path of their key."""
        found: dict[str, TimeHistory | None] = {
            "load.history": self.load.history,
            "motion.history": None if self.motion is None else self.motion.history,
            "contact.friction_history": self.contact.friction_history,
        }
        if self.heat is not None:
            found |= {f"heat.{key}": course for key, course in self.heat.histories.items()}
        return {key: course for key, course in found.items() if course is not None}

    @property
    def friction_variables(self) -> frozenset[str]:
        """Variables of the coefficient of friction and its factors: of p, v and T."""
        return self.contact.friction_variables

    @property
    def varies(self) -> bool:
        """True if friction, wear or conductance depend on temperature, pressure or speed."""
        conductance = None if self.heat is None else self.heat.conductance
        return (
            not isinstance(conductance, float | None)
            or bool(self.friction_variables)
            or any(law.factor.depends_on or law.follows_state for law in self.wear.laws.values())
            or any(law.follows_state for own in self.wear.values() for law in own.of_layers)
        )

    def tagged_mesh(self, zone: tuple[float, float] | None = None):
        """Mesh of the case for a contact zone (by default the expected one).

        Parameters
        ----------
        zone : tuple of float, optional
            Range of x [m].

        Raises
        ------
        CaseError
            If it has too many nodes, or nodes beyond the axis.
        """
        if zone is None:
            zone = self.geometry.expected_zone(self.pressing())
        mesh = self.meshed_geometry.build(self.mesh, zone)
        check_size(mesh, self.mesh.degree)
        x = mesh.points[:, 0]
        if self.model == "axisymmetric" and x.min() < -1e-9 * x.max():
            raise CaseError("geometry: x is the radius of an axisymmetric mesh, found x < 0")
        self.geometry.check(mesh, self)
        return mesh

    def part_named(self, body: str, name: str) -> str | None:
        """Part of a body by the name of its zone, or cell set of a mesh file; None if unknown."""
        return part_named(self.geometry, body, name)

    def material(self, part: str) -> Properties:
        """Material of a part, with ``like`` resolved; a zone may share the material of its body."""
        return self.located_material(part)[1]

    @property
    def initial_shapes(self) -> list[str]:
        """Files with initial worn shapes."""
        shape = self.geometry.initial_shape
        return [] if shape is None else [shape]

    def located_material(self, part: str) -> tuple[str, Properties]:
        """Path of the table that defines the material of a part, and this material.

        Raises
        ------
        ValueError
            If ``like`` names an unknown body, or is circular.
        """
        return located_material(self.geometry, self.bodies, part)


def as_plain(case: Section) -> dict[str, Any]:
    """Case as nested tables of text and numbers, including defaults.

    Keys of the mesh that an accuracy stands for are left out.
    """
    tables = case.model_dump(exclude_none=True)
    mesh = getattr(case, "mesh", None)
    if mesh is not None and mesh.accuracy is not None:
        chosen = MeshTable.CHOSEN - mesh.model_fields_set
        tables["mesh"] = {key: v for key, v in tables["mesh"].items() if key not in chosen}
    return tables
