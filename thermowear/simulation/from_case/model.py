"""Model of a case: bodies, materials, meshes, holder, motion and heat."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ...case.tables.geometry import Geometry, Pressing
from ...case.tables.schema import Case, MeshTable
from ...case.tables.tabulated import TemperatureHistory
from ...errors import CaseError
from ...geometry.mesh.tagged import TaggedMesh
from ...model.body import Body, Material
from ...model.heat import Heat
from ...model.holder import Holder, Motion
from ...model.meshes import Zone
from ...model.model import Discretisation, Model
from .interface import interface


def model_of(case: Case) -> Model:
    """Model of a validated case."""
    geometry = case.geometry
    return Model(
        kinematics=case.model,
        bodies=_bodies(case),
        interfaces=(interface(case),),
        holders=(_holder(case),),
        meshes=CaseMeshes(case.model, geometry, case.mesh, case),
        discretisation=Discretisation(case.mesh.degree, case.contact.positioning),
        motion=_motion(case),
        heat=_heat(case),
        thickness=geometry.thickness_factor,
        sector=geometry.sector,
        symmetry=geometry.symmetry,
        title=case.title,
    )


@dataclass(frozen=True)
class CaseMeshes:
    """Source of the meshes of a case, see `model.meshes.MeshSource`.

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
        return self.geometry.path if self.geometry.from_file else None  # type: ignore[attr-defined]

    def mesh(self, zone: Zone | None) -> TaggedMesh:
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
            fixed=() if surface in geometry.rollers else (surface,),
            rollers=tuple(s for s in geometry.rollers if s == surface or s.startswith(f"{name}_")),
            surfaces=tuple(s for s in geometry.surfaces if s.startswith(f"{name}_")),
            ring=1 / geometry.sector if name == moving else 1.0,
        )
        for name, surface in clamped
    )
    return first, second


def _material(case: Case, part: str) -> Material:
    """Material of a part, with ``like`` resolved; a zone may share the material of its body."""
    path, given = case.located_material(part)
    if given.young_modulus is None or given.poisson_ratio is None:
        raise CaseError(f"{path}: needs young_modulus and poisson_ratio")
    factors = given.expansion_factor, given.conductivity_factor
    expansion, conductivity = (None if factor is None else factor.table for factor in factors)
    return Material(
        young_modulus=given.young_modulus,
        poisson_ratio=given.poisson_ratio,
        expansion=given.expansion or 0.0,
        conductivity=given.conductivity,
        density=given.density,
        specific_heat=given.specific_heat,
        hardness=given.hardness,
        expansion_factor=expansion,
        conductivity_factor=conductivity,
        label=path,
    )


def _heat(case: Case) -> Heat | None:
    """Heat of a case; None if it is isothermal."""
    given = case.heat
    if given is None:
        return None
    history = given.ambient_history
    temperature = {
        surface: T.function if isinstance(T, TemperatureHistory) else T
        for surface, T in given.temperature.items()
    }
    return Heat(
        ambient=given.ambient,
        ambient_history=None if history is None else history.function,
        initial=given.initial,
        transient=given.transient,
        advection=given.advection,
        cooling=given.cooling,
        temperature=temperature,
        flux=given.flux,
        power=given.power,
    )


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
        surface_pressures=load.pressure,
    )


def _motion(case: Case) -> Motion:
    """Sliding motion; the mean speed along +x where it reciprocates."""
    geometry, given = case.geometry, case.motion
    at_rest = Motion(
        center=geometry.rotation_center,
        across=geometry.slides_across,
        passes=geometry.passes,
    )
    if given is None:
        return at_rest
    velocity, history = given.velocity, given.history
    if given.amplitude is not None and given.frequency is not None:
        velocity = 4 * given.amplitude * given.frequency
    return replace(
        at_rest,
        velocity=velocity,
        angular_velocity=given.angular_velocity,
        history=None if history is None else history.function,
    )
