"""Model of a case: bodies, materials and heat, with what its other tables describe."""

from __future__ import annotations

from ...case.tables.schema import Case
from ...case.tables.tabulated import TemperatureHistory
from ...errors import CaseError
from ...model.body import Body, Material
from ...model.heat import Heat
from ...model.model import Discretisation, Model
from .driving import holder, motion
from .interface import interface
from .meshes import CaseMeshes


def model_of(case: Case) -> Model:
    """Model of a validated case."""
    geometry = case.geometry
    return Model(
        kinematics=case.model,
        bodies=_bodies(case),
        interfaces=(interface(case),),
        holders=(holder(case),),
        meshes=CaseMeshes(case.model, geometry, case.mesh, case),
        discretisation=Discretisation(case.mesh.degree, case.contact.positioning),
        motion=motion(case),
        heat=_heat(case),
        thickness=geometry.thickness_factor,
        sector=geometry.sector,
        symmetry=geometry.symmetry,
        title=case.title,
    )


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
