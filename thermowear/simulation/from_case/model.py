"""Model of a case: bodies, materials, meshes, interface, holder, motion and heat."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from ...case.tables.analyses import Fretting
from ...case.tables.conditions import AxisTable
from ...case.tables.geometry import Geometry
from ...case.tables.laws import PressureConductanceTable, TabulatedConductanceTable, law_of
from ...case.tables.materials import Properties
from ...case.tables.mesh import MeshTable
from ...case.tables.probes import ProbeTable
from ...case.tables.schema import Case
from ...case.tables.tabulated import (
    ExpansionTable,
    FactorHistory,
    TemperatureHistory,
    TemperatureTable,
)
from ...case.tables.wear import BodyWearTable
from ...case.values.pressing import Pressing
from ...case.values.section import Section
from ...errors import CaseError
from ...geometry.mesh.mixed import AnyMesh
from ...laws.distribution import IN_PLACE, Distribution
from ...laws.interfaces import Law, Multipliers
from ...model.body import Body, Material
from ...model.conditions import Heat, Holder, Motion
from ...model.face_wear import Wear
from ...model.interface import ContactMethod, HardnessConductance, Interface
from ...model.model import Discretisation, Model, Zone
from ...model.probe import Probe
from ...model.tracks import CircularTrack, EvenTrack, PinTrack, TabulatedTrack, Track
from .wear import body_wear


def pair_of(case: Case) -> Model:
    """Model of a validated case of two bodies."""
    geometry = case.geometry
    return Model(
        kinematics=case.model,
        bodies=_bodies(case),
        interfaces=(_interface(case),),
        holders=(_holder(case),),
        meshes=CaseMeshes(case.model, case.meshed_geometry, case.mesh, case),
        discretisation=Discretisation(case.mesh.degree, case.contact.positioning, case.mesh.solver),
        heat=None if case.heat is None else Heat(**attributes(Heat, case.heat)),
        thickness=geometry.thickness_factor,
        sector=geometry.sector,
        symmetry=geometry.symmetry,
        title=case.title,
        probes=probes_of(case.probes),
        surface_pressures=case.load.pressure,
    )


def probes_of(tables: Mapping[str, ProbeTable]) -> tuple[Probe, ...]:
    """Probes from their tables."""
    return tuple(Probe(name, **attributes(Probe, table)) for name, table in tables.items())


@dataclass(frozen=True)
class CaseMeshes:
    """Source of the meshes of a case, see `model.model.MeshSource`.

    Attributes
    ----------
    kinematics : str
    geometry : Geometry
    settings : MeshTable
    case : Case
        Case that the mesh is checked against.
    """

    kinematics: str
    geometry: Geometry
    settings: MeshTable
    case: Case = field(compare=False, repr=False)

    @property
    def path(self) -> str | None:
        return self.geometry.mesh_files

    def mesh(self, zone: Zone | None) -> AnyMesh:
        return self.case.tagged_mesh(zone)

    def expected_zone(
        self, force: float | None, approach: float | None, modulus: float
    ) -> Zone | None:
        return self.geometry.expected_zone(Pressing(force, approach, modulus))


def _bodies(case: Case) -> tuple[Body, Body]:
    """Bodies of the geometry of a case."""
    geometry = case.geometry
    moving = geometry.bodies[1]
    clamped = zip(geometry.bodies, (geometry.held, geometry.fixed), strict=True)
    first, second = (
        Body(
            name=name,
            materials={part: _material(case, part) for part in geometry.parts_of(name)},
            fixed=() if surface in (*geometry.rollers, *geometry.mid_plane) else (surface,),
            rollers=geometry.rollers_of(name),
            mid_plane=geometry.mid_plane_of(name),
            surfaces=tuple(s for s in geometry.surfaces if s.startswith(f"{name}_")),
            ring=1 / geometry.sector if name == moving else 1.0,
        )
        for name, surface in clamped
    )
    return first, second


def _material(case: Case, part: str) -> Material:
    """Material of a part, with ``like`` resolved; a zone may share the material of its body."""
    return material(*case.located_material(part))


def material(path: str, given: Properties) -> Material:
    """Material from the table at a path."""
    if given.young_modulus is None or given.poisson_ratio is None:
        raise CaseError(f"{path}: needs young_modulus and poisson_ratio")
    return Material(**attributes(Material, given), label=path)


def _holder(case: Case) -> Holder:
    """Holder of body 1 and the loads on it."""
    load, geometry, free = case.load, case.geometry, case.holder.free
    dim = len(geometry.press_direction)
    pivot = np.array(case.holder.pivot or geometry.pivot_point or np.zeros(dim), dtype=float)
    point = pivot + (load.lever or 0.0) * np.eye(dim)[0]
    if load.point is not None:
        point[: len(load.point)] = load.point
    about_x, about_y = load.moments or (0.0, 0.0)
    return Holder(
        load_direction=geometry.press_direction,
        pivot=tuple(map(float, pivot)),
        point=tuple(map(float, point)),
        free=free,
        force=case.force(),
        approach=case.approach(),
        tangential_force=load.tangential_force or 0.0,
        moments=(about_x, about_y, load.moment or 0.0),
        closing_moment=load.moment if free == ("rotation",) else None,
        history=None if load.history is None else load.history.loads,
        surface_forces=load.surfaces,
    )


def _motion(case: Case) -> Motion:
    """Sliding motion; the mean speed along +x where it reciprocates."""
    geometry, given = case.geometry, case.motion
    found = {} if given is None else attributes(Motion, given)
    if given is not None and given.amplitude is not None and given.frequency is not None:
        found["velocity"] = 4 * given.amplitude * given.frequency
    return Motion(
        center=geometry.rotation_center,
        across=geometry.slides_across,
        passes=geometry.passes,
        **found,
    )


def attributes(kind: type, table: Section) -> dict[str, Any]:
    """Attributes of a class of the model from the keys of the same names; without absent keys."""
    names = type(table).model_fields.keys() & {attribute.name for attribute in fields(kind)}
    return {
        name: _in_model(getattr(table, name))
        for name in sorted(names)
        if getattr(table, name) is not None
    }


def _in_model(value: Any) -> Any:
    """Tables as functions of temperature or time, also by surface; other values are kept."""
    if isinstance(value, Mapping):
        return {name: _in_model(each) for name, each in value.items()}
    if isinstance(value, TemperatureTable | ExpansionTable):
        return value.table
    if isinstance(value, AxisTable):
        return value.axis
    return value.function if isinstance(value, FactorHistory | TemperatureHistory) else value


def _interface(case: Case) -> Interface:
    """Interface of a case."""
    contact, heat = case.contact, case.heat
    history = contact.friction_history
    return Interface(
        faces=case.geometry.contact,
        motion=_motion(case),
        friction=contact.friction_law,
        friction_factors=contact.friction_factor.multipliers,
        friction_history=None if history is None else history.function,
        transverse_friction=contact.transverse_friction,
        conductance=_conductance(case),
        gap_conductance=0.0 if heat is None else heat.gap_conductance or 0.0,
        partition=0.5 if heat is None else heat.partition,
        wear=_wear(case),
        closes_by_wear=not isinstance(case.analysis, Fretting),
        compliance=contact.compliance or 0.0,
        fluid_pressure=contact.fluid_pressure,
        initial_shape=case.geometry.initial_shape,
        pressure_degree=contact.pressure_degree,
        method=ContactMethod(
            contact.method,
            contact.penalty,
            1 if contact.theta is None else contact.theta,
            contact.gamma,
        ),
    )


def _conductance(case: Case) -> Law | HardnessConductance | None:
    """Contact conductance of a case; None: perfect contact, or no heat."""
    return None if case.heat is None else conductance(case.heat.conductance, "heat.conductance")


def conductance(given: Any, path: str) -> Law | HardnessConductance | None:
    """Contact conductance from the value of the key at a path; None: perfect contact."""
    if isinstance(given, TabulatedConductanceTable):
        return Multipliers({"p": given.table})
    if isinstance(given, PressureConductanceTable):
        return HardnessConductance(given.coefficient)
    return None if given is None else law_of(given, path, 0.0)


def _wear(case: Case) -> dict[int, Wear]:
    """Wear of the faces by index; bodies without a wear table do not wear."""
    return {
        index: body_wear(
            case.geometry, name, case.wear[name], case.contact, _track(case, case.wear[name])
        )
        for index, name in enumerate(case.geometry.bodies)
        if name in case.wear
    }


def _track(case: Case, wear: BodyWearTable) -> Distribution | Track:
    geometry = case.geometry
    if wear.spread == "in-place":
        return IN_PLACE
    if geometry.footprint is not None and geometry.rotation_center is not None:
        return PinTrack(geometry.rotation_center, *geometry.footprint)
    if geometry.duty_by_radius is not None and geometry.rotation_center is not None:
        return TabulatedTrack(geometry.rotation_center, *geometry.duty_by_radius)
    if geometry.duty is not None and geometry.rotation_center is not None:
        return CircularTrack(geometry.rotation_center, geometry.duty)
    return Distribution(geometry.sector) if geometry.track is None else EvenTrack(geometry.track)
