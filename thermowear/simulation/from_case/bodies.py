"""Bodies and materials of a case."""

from __future__ import annotations

from ...case.tables.schema import Case
from ...errors import CaseError
from ...model.body import Body
from ...model.material import Material


def bodies(case: Case) -> tuple[Body, Body]:
    """Bodies of the geometry of a case."""
    geometry = case.geometry
    moving = geometry.bodies[1]
    clamped = zip(geometry.bodies, (geometry.held, geometry.fixed), strict=True)
    first, second = (
        Body(
            name=name,
            materials={part: material(case, part) for part in geometry.parts_of(name)},
            fixed=() if surface in geometry.rollers else (surface,),
            rollers=tuple(s for s in geometry.rollers if s == surface or s.startswith(f"{name}_")),
            surfaces=tuple(s for s in geometry.surfaces if s.startswith(f"{name}_")),
            ring=1 / geometry.sector if name == moving else 1.0,
        )
        for name, surface in clamped
    )
    return first, second


def material(case: Case, part: str) -> Material:
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
