"""Consistency checks of materials."""

from __future__ import annotations

from collections.abc import Iterator

from ..any_case import AnyCase
from ..assembly.tables import SUPPORTS
from ..tables.materials import set_with_material
from ..tables.schema import Case
from ..values.section import Fault

_LOCKING = {1: 0.45, 2: 0.499}
"""Largest Poisson ratio by degree, measured for a cylinder on a block with 16 elements in
contact: up to this value the error of the force is at most twice that at 0.3; no limit from
degree 3 on."""


def locking(case: AnyCase) -> Iterator[Fault]:
    """Volumetric locking of low-order elements at nearly constant volume."""
    limit = _LOCKING.get(case.mesh.degree)
    if limit is None or case.model == "plane-stress":
        return
    for name, body in case.bodies.items():
        sets = {f"{name}.materials.{key}": table for key, table in body.materials.items()}
        for path, table in {name: body, **sets}.items():
            if table.poisson_ratio is not None and table.poisson_ratio > limit:
                yield (
                    f"bodies.{path}.poisson_ratio",
                    f"found {table.poisson_ratio:g}; elements of mesh.degree = {case.mesh.degree} "
                    f"lock (become too stiff) above {limit:g}; use mesh.degree = 3 or more",
                )


def materials(case: Case) -> Iterator[Fault]:
    """Valid references by ``like``, and all properties that the analysis requires."""
    geometry, sources = case.geometry, {}
    for part in geometry.parts:
        name = part if part in case.bodies else geometry.zones.get(part, part)
        if name not in case.bodies:
            continue
        in_set = set_with_material(geometry, case.bodies, part)
        path = f"bodies.{name}" if in_set is None else f"bodies.{name}.materials.{in_set}"
        try:
            sources[part] = case.located_material(part)
        except ValueError as error:
            if part == name or in_set is not None:
                yield f"{path}.like", str(error)
    missing: dict[str, str] = {}
    for parts, keys, why in _required(case):
        for part in parts:
            for key in keys if part in sources else ():
                path, material = sources[part]
                if getattr(material, key) is None:
                    missing.setdefault(f"{path}.{key}", f"missing; needed{why}")
    yield from missing.items()


def like_alone(case: AnyCase) -> Iterator[Fault]:
    """A body or cell set with the material of another one has no properties of its own."""
    for name, body in case.bodies.items():
        sets = {f"{name}.materials.{key}": table for key, table in body.materials.items()}
        for path, table in {name: body, **sets}.items():
            own = table.model_fields_set - {"like", "materials", *SUPPORTS}
            for key in sorted(own) if table.like is not None else ():
                yield f"bodies.{path}.{key}", "not allowed together with like"


def cell_sets(case: AnyCase) -> Iterator[Fault]:
    """Materials by cell set require bodies of a mesh file, with a material for each cell."""
    geometry = case.geometry
    for name, body in case.bodies.items():
        if body.materials and not geometry.set_of:
            yield (
                f"bodies.{name}.materials",
                f'needs cell sets of a mesh file (geometry.type = "file"), found {geometry.type!r}',
            )
        elif body.materials and name in geometry.bodies and not body.has_own:
            for left in geometry.sets_of(name):
                if left not in body.materials:
                    yield (
                        f"bodies.{name}.young_modulus",
                        f"missing; cells of {left!r} may be in no set of bodies.{name}.materials",
                    )


def _required(case: Case) -> Iterator[tuple[tuple[str, ...], tuple[str, ...], str]]:
    """Parts, required keys of their materials, and the reason."""
    heat, geometry = case.heat, case.geometry
    storing = ("density", "specific_heat")
    yield geometry.parts, ("young_modulus", "poisson_ratio"), ""
    if heat is None:
        return
    facing = tuple(part for part in geometry.facing if part is not None)
    yield geometry.parts, ("conductivity", "expansion"), " because the case has a [heat] table"
    if heat.transient:
        yield geometry.parts, storing, " because heat.transient is true"
    if heat.advection == "resolved":
        moving = geometry.parts_of(geometry.bodies[1])
        yield moving, storing, ' because heat.advection is "resolved"'
    if heat.partition == "effusivity":
        yield facing, storing, ' because heat.partition is "effusivity"'
    if getattr(heat.conductance, "type", None) == "pressure":
        yield facing, ("hardness",), ' because heat.conductance is of type "pressure"'
