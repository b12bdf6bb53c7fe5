"""Model of a case of several bodies."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...case.assembly.geometry import AssemblyGeometry
from ...case.assembly.schema import AssemblyCase
from ...case.assembly.tables import AssemblyContactTable, AssemblyHolderTable, BodyMotionTable
from ...case.tables.analyses import Fretting
from ...case.tables.mesh import MeshTable
from ...errors import CaseError
from ...geometry.mesh.mixed import AnyMesh
from ...laws.distribution import IN_PLACE, Distribution
from ...model.body import Body
from ...model.conditions import Heat, Holder, Motion
from ...model.face_wear import Wear
from ...model.interface import Interface
from ...model.model import Discretisation, Model, Zone, hanging_holders
from ...model.relative_motion import relative_motion
from ...model.tie import Tie, glued_bodies, with_glued
from ...model.tracks import EvenTrack, Track
from .model import attributes, conductance, material, probes_of
from .wear import body_wear


def assembly_of(case: AssemblyCase) -> Model:
    """Model of a validated case of several bodies."""
    geometry, ties = case.geometry, _ties(case)
    groups = glued_bodies(len(geometry.bodies), ties)
    bodies = tuple(_body(case, name) for name in geometry.bodies)
    symmetry = tuple(surface for body in case.bodies.values() for surface in body.symmetry)
    holders = _holders(case, groups)
    held = {index for holder in holders for index in holder.bodies}
    return Model(
        kinematics=case.model,
        bodies=bodies,
        interfaces=tuple(
            _interface(case, name, table) for name, table in case.contacts.items() if not table.tie
        ),
        holders=(*holders, *hanging_holders(case.model, bodies, symmetry, groups, held)),
        meshes=AssemblyMeshes(case.model, case.meshed_geometry, case.mesh, case),
        discretisation=Discretisation(case.mesh.degree, solver=case.mesh.solver),
        heat=None if case.heat is None else Heat(**attributes(Heat, case.heat)),
        thickness=geometry.thickness_factor if case.model.startswith("plane") else None,
        sector=geometry.sector,
        symmetry=symmetry,
        title=case.title,
        ties=ties,
        probes=probes_of(case.probes),
        surface_pressures=case.load.pressure,
    )


@dataclass(frozen=True)
class AssemblyMeshes:
    """Source of the meshes of a case of several bodies, see `model.model.MeshSource`.

    Attributes
    ----------
    kinematics : str
    geometry : AssemblyGeometry
    settings : MeshTable
    case : AssemblyCase
    """

    kinematics: str
    geometry: AssemblyGeometry
    settings: MeshTable
    case: AssemblyCase = field(compare=False, repr=False)

    @property
    def path(self) -> str | None:
        return self.geometry.mesh_files

    def mesh(self, zone: Zone | None) -> AnyMesh:
        return self.case.tagged_mesh()

    def expected_zone(
        self, force: float | None, approach: float | None, modulus: float
    ) -> Zone | None:
        return None


def _body(case: AssemblyCase, name: str) -> Body:
    geometry, table = case.geometry, case.bodies[name]
    guided = {*table.symmetry, *table.rollers, *table.mid_plane}
    held = [s for h in case.holders.values() for s in h.surface if geometry.body_of(s) == name]
    return Body(
        name=name,
        materials={
            part: material(*case.located_material(part)) for part in geometry.parts_of(name)
        },
        fixed=tuple(surface for surface in (*held, *table.fixed) if surface not in guided),
        rollers=table.rollers,
        mid_plane=table.mid_plane,
        surfaces=tuple(s for s in geometry.surfaces if geometry.body_of(s) == name),
        ring=1 / geometry.sector if name in geometry.rings else 1.0,
    )


def _interface(case: AssemblyCase, name: str, table: AssemblyContactTable) -> Interface:
    geometry, faces = case.geometry, table.between
    assert faces is not None  # the case has been checked
    bodies = [geometry.body_of(face) for face in faces]
    one, other = (_motion(case.motions.get(body)) for body in bodies)
    history = table.friction_history
    return Interface(
        faces=faces,
        bodies=(geometry.bodies.index(bodies[0]), geometry.bodies.index(bodies[1])),
        name=name,
        motion=relative_motion(one, other, case.model == "axisymmetric"),
        friction=table.friction_law,
        friction_factors=table.friction_factor.multipliers,
        friction_history=None if history is None else history.function,
        transverse_friction=table.transverse_friction,
        conductance=conductance(table.conductance, f"contacts.{name}.conductance"),
        gap_conductance=table.gap_conductance or 0.0,
        partition=0.5 if table.partition is None else table.partition,
        wear={
            side: _wear(case, face, table)
            for side, (body, face) in enumerate(zip(bodies, faces, strict=True))
            if body in case.wear
        },
        closes_by_wear=not isinstance(case.analysis, Fretting),
        compliance=table.compliance or 0.0,
        fluid_pressure=table.fluid_pressure,
        initial_shape=table.initial_shape,
        pressure_degree=table.pressure_degree,
    )


def _motion(table: BodyMotionTable | None) -> Motion | None:
    """Motion of a body in the frame of the model."""
    if table is None:
        return None
    return Motion(
        velocity=table.mean_velocity,
        angular_velocity=table.angular_velocity,
        center=table.center,
        axis=None if table.axis is None else table.axis.axis,
        across=table.across,
        history=None if table.history is None else table.history.function,
    )


def _wear(case: AssemblyCase, face: str, table: AssemblyContactTable) -> Wear:
    """Wear of a face of a contact."""
    body = case.geometry.body_of(face)
    return body_wear(case.geometry, body, case.wear[body], table, _track(case, body, face))


def _track(case: AssemblyCase, body: str, face: str) -> Distribution | Track:
    """Track over which the wear of a face of a body is spread, or its distribution."""
    geometry = case.geometry
    if case.wear[body].spread == "in-place":
        return IN_PLACE
    passing = geometry.track(face)
    if passing is None:
        return Distribution(geometry.sector)
    name, length = passing
    return EvenTrack(length, name)


def _ties(case: AssemblyCase) -> tuple[Tie, ...]:
    """Glued faces."""
    found = []
    for name, table in case.contacts.items():
        if table.tie and table.between is not None:
            bodies = [case.geometry.bodies.index(case.geometry.body_of(s)) for s in table.between]
            h = table.conductance
            if not isinstance(h, float | None):
                raise CaseError(f"contacts.{name}.conductance: a joint needs a constant one")
            found.append(Tie(table.between, (bodies[0], bodies[1]), name, h))
    return tuple(found)


def _holders(case: AssemblyCase, groups: list[tuple[int, ...]]) -> tuple[Holder, ...]:
    """Holders, each with the bodies that are glued to its own."""
    each = [_holder(case, name, table) for name, table in case.holders.items()]
    for holder in each:
        holder["bodies"] = with_glued(holder["bodies"], groups)
    return tuple(Holder(**holder) for holder in each)


def _holder(case: AssemblyCase, name: str, table: AssemblyHolderTable) -> dict:
    """Attributes of a holder."""
    geometry, history = case.geometry, table.history
    dim = 3 if case.model == "3d" else 2
    direction = np.array(table.direction or geometry.press_direction(table.surface[0]), dtype=float)
    pivot = table.pivot or geometry.pivot(table.surface[0]) or (0.0,) * dim
    maxima = {
        key: max(course) if history is not None and (course := getattr(history, key)) else given
        for key, given in (("force", table.force), ("approach", table.approach))
    }
    return {
        "name": name,
        "bodies": tuple(geometry.bodies.index(geometry.body_of(s)) for s in table.surface),
        "load_direction": tuple(map(float, direction / np.linalg.norm(direction))),
        "pivot": pivot,
        "point": table.point or pivot,
        "free": table.free,
        "tangential_force": table.tangential_force or 0.0,
        "moments": table.moments or (0.0, 0.0, 0.0),
        "closing_moment": table.closing_moment,
        "history": None if history is None else history.loads,
        "reaction": table.reaction or "",
        **maxima,
    }
