"""Materials of a body, or the name of the body whose material it shares."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Annotated, Any

from pydantic import Field

from ...errors import CaseError, quoted
from ..values import units
from ..values.section import Number, Section
from .tabulated import ExpansionTable, TemperatureTable

SQUEEZED = 0.2
"""Largest strain; beyond it small strains are invalid."""


class Properties(Section):
    """Keys of `model.body.Material`, or the name of the body whose material applies (``like``).

    Tables of factors are `conductivity_factor` and `expansion_factor`.

    Attributes
    ----------
    like : str or None
        Body whose material this one shares, in place of all other keys.
    """

    like: str | None = None
    young_modulus: units.Pressure | None = None
    poisson_ratio: Annotated[Number, Field(gt=-1.0, lt=0.5)] | None = None
    conductivity: units.Conductivity | None = None
    expansion: units.Expansion | None = None
    density: units.Density | None = None
    specific_heat: units.SpecificHeat | None = None
    hardness: units.Pressure | None = None
    yield_strength: units.Pressure | None = None
    conductivity_factor: TemperatureTable | None = None
    expansion_factor: ExpansionTable | None = None


def contact_modulus(materials: Iterable[Properties]) -> float:
    """Contact modulus ``1/E* = Σ (1 - ν²)/E`` of checked materials [Pa]."""
    softness = 0.0
    for body in materials:
        assert body.young_modulus is not None
        assert body.poisson_ratio is not None
        softness += (1 - body.poisson_ratio**2) / body.young_modulus
    return 1 / softness


class MaterialTable(Properties):
    """Material of a cell set in a body."""


class BodyTable(Properties):
    """Material of a body, and of cell sets in it.

    Attributes
    ----------
    materials : dict of str to MaterialTable
        Materials by cell set of a mesh file. All other cells of the body have the body's own
        material, which may be omitted if every cell set of the body has one.
    """

    materials: dict[str, MaterialTable] = {}

    @property
    def has_own(self) -> bool:
        """True if the body has a material of its own, besides those of its cell sets."""
        return bool(self.model_fields_set - {"materials"})


def cell_sets(bodies: Mapping[str, BodyTable], wear: Any) -> dict[str, dict[str, str]]:
    """Cell sets with a material or wear law of their own, and the paths of their tables, by body.

    Parameters
    ----------
    bodies : mapping of str to BodyTable
    wear : WearTable
    """
    sets: dict[str, dict[str, str]] = {}
    for kind, tables in (("bodies", bodies), ("wear", wear)):
        for name, table in tables.items():
            for part, own in table.materials.items():
                if getattr(own, "where", None) is not None:
                    continue
                sets.setdefault(name, {}).setdefault(part, f"{kind}.{name}.materials.{part}")
    return sets


def part_named(geometry: Any, body: str, name: str) -> str | None:
    """Part of a body by the name of its zone, or cell set of a mesh file; None if unknown.

    Parameters
    ----------
    geometry : Geometry or AssemblyGeometry
    body, name : str
    """
    zones, set_of = geometry.parts_of(body)[1:], geometry.set_of
    return next((part for part in zones if set_of.get(part, part) == name), None)


def set_with_material(geometry: Any, bodies: Mapping[str, BodyTable], part: str) -> str | None:
    """Cell set that a part represents and that has a material; a wear law alone is none."""
    owner, chosen = geometry.zones.get(part, part), geometry.set_of.get(part)
    return chosen if owner in bodies and chosen in bodies[owner].materials else None


def located_material(
    geometry: Any, bodies: Mapping[str, BodyTable], part: str
) -> tuple[str, Properties]:
    """Path of the table that defines the material of a part, and this material.

    Parameters
    ----------
    geometry : Geometry or AssemblyGeometry
    bodies : mapping of str to BodyTable
    part : str

    Raises
    ------
    ValueError
        If ``like`` names an unknown body, or is circular.
    """
    owner = geometry.zones.get(part, part)
    name = part if part in bodies else owner
    chosen = set_with_material(geometry, bodies, part)
    if chosen is None and not bodies[name].has_own and bodies[name].materials:
        chosen = next(iter(bodies[name].materials))  # all of its cells are in sets
    table: Properties = bodies[name]
    path = f"bodies.{name}"
    if chosen is not None:
        path, table = f"bodies.{owner}.materials.{chosen}", bodies[owner].materials[chosen]
    seen = [path]
    while (other := table.like) is not None:
        path, known = f"bodies.{other}", ", ".join(bodies)
        if other not in bodies:
            raise ValueError(f"like = {quoted(other)} names no body; one of: {known}")
        if path in seen:
            raise ValueError(f"like = {quoted(other)} is a circular reference")
        seen.append(path)
        table = bodies[other]
    return path, table


def softest(case: Any) -> tuple[str, float]:
    """Part of a case with the least modulus, and that modulus [Pa]."""
    moduli = {p: case.located_material(p)[1].young_modulus or math.inf for p in case.geometry.parts}
    softer = min(moduli, key=moduli.__getitem__)
    return softer, moduli[softer]


def check_pressure(path: str, pressure: float, where: str, case: Any) -> None:
    """Reject a mean pressure that is a large part of the modulus of the softest part.

    Parameters
    ----------
    path : str
        Key of the load.
    pressure : float
        [Pa]
    where : str
        What it acts on, for the message.
    case : Case or AssemblyCase

    Raises
    ------
    CaseError
    """
    softer, modulus = softest(case)
    if pressure > SQUEEZED * modulus:
        unit = "geometry.length_unit" if case.geometry.from_file else "the units"
        raise CaseError(
            f"{path}: a mean pressure of {pressure / 1e6:.4g} MPa{where} is "
            f"{pressure / modulus:.2g} times the modulus of {softer!r} (check {unit})"
        )
