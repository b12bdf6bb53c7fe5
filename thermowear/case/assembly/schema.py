"""Case of more than two bodies: its tables, and the contacts that they describe."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from ...errors import CaseError
from ...laws.histories import LoadHistories
from ..studies.calibration import CalibrationTable
from ..studies.study import StudyTable
from ..tables.analyses import Fretting, Initial, Reciprocating, Stability, Steady, Transient
from ..tables.conditions import HeatTable
from ..tables.contact import InterfaceTable
from ..tables.materials import Properties, cell_sets, contact_modulus, located_material
from ..tables.mesh import MeshTable, check_size
from ..tables.probes import ProbeTable
from ..tables.tabulated import TimeHistory
from ..tables.wear import WearTable
from ..values.pressing import Pressing, resolving
from ..values.section import Section
from .geometry import AnyAssembly
from .tables import (
    AssemblyBodyTable,
    AssemblyContactTable,
    AssemblyHolderTable,
    BodyMotionTable,
    SurfaceLoadTable,
)

_THERMAL = ("conductance", "gap_conductance", "partition")
"""Keys of ``heat`` that contacts share."""


class AssemblyCase(Section):
    """Complete case of several bodies.

    Attributes
    ----------
    contact : InterfaceTable
        Values that the contacts share; those of `conductance`, `gap_conductance` and `partition`
        are in ``heat``.
    contacts : dict of str to AssemblyContactTable
        By default those of the geometry; complete once the case has been read.
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
        Material and supports of each body, by its name in the geometry.
    holders : dict of str to AssemblyHolderTable
        Rigid holders of bodies, by name; none where supports hold all bodies, or contacts that
        leave a single position.
    load : LoadTable
        Pressures on surfaces.
    motions : dict of str to BodyMotionTable
        Sliding motion of each moving body, by its name.
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
    geometry: AnyAssembly
    mesh: MeshTable = MeshTable()
    bodies: dict[str, AssemblyBodyTable]
    contact: InterfaceTable = InterfaceTable()
    contacts: dict[str, AssemblyContactTable] = {}
    holders: dict[str, AssemblyHolderTable] = {}
    load: SurfaceLoadTable = SurfaceLoadTable()
    motions: dict[str, BodyMotionTable] = {}
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

    @model_validator(mode="after")
    def _all_contacts(self):
        """Contacts of the geometry by default, each with the values that all of them share."""
        given = self.contacts or {name: AssemblyContactTable() for name in self.geometry.contacts}
        found = {name: self._complete(name, table) for name, table in given.items()}
        object.__setattr__(self, "contacts", found)
        sliding = tuple(t.between for t in found.values() if t.between and not t.tie)
        object.__setattr__(self, "geometry", self.geometry.with_sliding(sliding))
        return self

    def _complete(self, name: str, table: AssemblyContactTable) -> AssemblyContactTable:
        shared: dict[str, Any] = {}
        if not table.tie:
            shared = {key: getattr(self.contact, key) for key in _set(self.contact)}
        if self.heat is not None and not table.tie:
            thermal = {key: getattr(self.heat, key) for key in _THERMAL}
            shared |= {key: value for key, value in thermal.items() if value is not None}
        own = {key: getattr(table, key) for key in _set(table)}
        between = {"between": table.between or self.geometry.contacts.get(name)}
        return AssemblyContactTable.model_construct(**(shared | own | between))

    def located_material(self, part: str) -> tuple[str, Properties]:
        """Path of the table that defines the material of a part, and this material."""
        return located_material(self.geometry, self.bodies, part)

    @property
    def glued(self) -> dict[str, set[str]]:
        """Bodies glued to each body, directly or by others, with itself."""
        groups = {body: {body} for body in self.geometry.bodies}
        for contact in self.contacts.values():
            if contact.tie and contact.between is not None:
                one, other = (groups[self.geometry.body_of(face)] for face in contact.between)
                groups |= dict.fromkeys(one | other, one | other)
        return groups

    @property
    def hanging(self) -> list[str]:
        """Bodies that neither a holder nor a clamped surface holds, alone or glued to others."""
        held = {self.geometry.body_of(s) for h in self.holders.values() for s in h.surface}
        held |= {body for body in self.geometry.bodies if self.bodies[body].fixed}
        return [body for body in self.geometry.bodies if held.isdisjoint(self.glued[body])]

    @property
    def contact_tables(self) -> dict[str, InterfaceTable]:
        """Tables of the contacts that slide, by their path."""
        return {f"contacts.{name}": table for name, table in self.sliding.items()}

    @property
    def sliding(self) -> dict[str, AssemblyContactTable]:
        """Contacts that slide, by name."""
        return {name: table for name, table in self.contacts.items() if not table.tie}

    @property
    def sliding_bodies(self) -> set[str]:
        """Bodies with a contact that slides."""
        faces = [face for table in self.sliding.values() for face in table.between or ()]
        return set(map(self.geometry.body_of, faces))

    @property
    def meshed_geometry(self) -> AnyAssembly:
        """Geometry with what its mesh follows from."""
        return resolving(self, self._pressing)

    def _pressing(self) -> list[Pressing | None]:
        """Loads of the contacts that slide: the largest one of all holders presses each."""
        held, histories = self.holders.values(), [h.history for h in self.holders.values()]
        forces = [h.force or 0.0 for h in held] + [max(h.force or (0.0,)) for h in histories if h]
        approaches = [h.approach or 0.0 for h in held]
        approaches += [max(h.approach or (0.0,)) for h in histories if h]
        force, approach = (max(loads, default=0.0) or None for loads in (forces, approaches))

        def on(table: AssemblyContactTable) -> Pressing | None:
            bodies = map(self.geometry.body_of, table.between or ())
            parts = (self.geometry.parts_of(body)[:2][-1] for body in bodies)
            modulus = contact_modulus(self.located_material(part)[1] for part in parts)
            return Pressing(force, None if force else approach, modulus)

        return [on(table) if force or approach else None for table in self.sliding.values()]

    @property
    def histories(self) -> dict[str, TimeHistory]:
        """Time histories by the path of their key."""
        found: dict[str, TimeHistory | None]
        found = {f"holders.{name}.history": h.history for name, h in self.holders.items()}
        found |= {f"motions.{name}.history": m.history for name, m in self.motions.items()}
        for path, table in self.contact_tables.items():
            found[f"{path}.friction_history"] = table.friction_history
        if self.heat is not None:
            found |= {f"heat.{key}": course for key, course in self.heat.histories.items()}
        return {key: course for key, course in found.items() if course is not None}

    @property
    def initial_shapes(self) -> list[str]:
        """Files with initial worn shapes."""
        shapes = (contact.initial_shape for contact in self.contacts.values())
        return [shape for shape in shapes if shape is not None]

    @property
    def cycles(self) -> float | None:
        """Number of cycles of the loads; None if none is given."""
        in_analysis = getattr(self.analysis, "cycles", None)
        return self.wear.cycles if in_analysis is None else in_analysis

    @property
    def reciprocation(self) -> tuple[float, float] | None:
        """Largest amplitude [m] and frequency [Hz] of reciprocating bodies; None without any."""
        each = [(m.amplitude, m.frequency) for m in self.motions.values()]
        given = [(x, f) for x, f in each if x is not None and f is not None]
        return max(given, default=None)

    @property
    def load_histories(self) -> LoadHistories:
        """Load histories of the holders that have one."""
        each = [h.history.loads for h in self.holders.values() if h.history is not None]
        return LoadHistories(tuple(each))

    def tagged_mesh(self):
        """Mesh of the case.

        Raises
        ------
        CaseError
            If it has too many nodes, or nodes beyond the axis.
        """
        mesh = self.meshed_geometry.build(self.mesh)
        check_size(mesh, self.mesh.degree)
        x = mesh.points[:, 0]
        if self.model == "axisymmetric" and x.min() < -1e-9 * x.max():
            raise CaseError("geometry: x is the radius of an axisymmetric mesh, found x < 0")
        self.geometry.check(mesh, self)
        return mesh


def _set(table: Section) -> set[str]:
    return set(table.model_fields_set)
