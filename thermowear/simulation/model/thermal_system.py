"""Heat conduction in the bodies of a case and heat exchange at their contact."""

from __future__ import annotations

from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np

from ...bulk.bodies import Bodies
from ...bulk.field import lagrange_space
from ...bulk.heat.advection import Passage
from ...bulk.heat.conduction import Conduction
from ...bulk.heat.heat_equation import ThermalMaterial, conduction
from ...bulk.heat.varying import (
    VaryingConduction,
    VaryingExpansion,
    thermal_forces,
    varying_conduction,
    varying_expansion,
)
from ...bulk.kinematics import Model
from ...bulk.mechanics.elasticity import Elasticity
from ...case.tables.facing import Facing
from ...case.tables.schema import Case
from ...contact.operators.heat import InterfaceHeat
from ...contact.operators.heat_condensation import bath_matrix, condense_heat
from ...contact.operators.traces import value_trace
from ...contact.search.pairing import Pairing
from ...timer import Phases
from .interface_laws import partition
from .thermal_loads import ThermalLoads, temperature_at, thermal_loads


@dataclass(frozen=True)
class ThermalSystem:
    """Conducting bodies, their thermal loads and the heat exchange at the interface.

    Attributes
    ----------
    conduction : Conduction
    load : petsc4py.PETSc.Mat
        G: nodal forces per nodal rise [N/K].
    loads : ThermalLoads
        Thermal loads beside friction.
    face : InterfaceHeat
    ambient : float
        Ambient temperature [K].
    initial : float
        Initial rise over the ambient temperature in transient conduction [K].
    diffusivity : float
        Largest diffusivity of the materials; zero where none is known [m²/s].
    expansions : tuple of VaryingExpansion
        Temperature-dependent expansions, one per part with a table.
    """

    conduction: Conduction
    load: PETSc.Mat
    loads: ThermalLoads
    face: InterfaceHeat
    ambient: float
    initial: float
    diffusivity: float
    expansions: tuple[VaryingExpansion, ...]

    @property
    def varies(self) -> bool:
        """True if conductivity or expansion depend on temperature."""
        return isinstance(self.conduction, VaryingConduction)

    def forces(self, rise: np.ndarray) -> np.ndarray:
        """Nodal forces of a temperature rise, owned rows [N]."""
        return thermal_forces(self.load, self.expansions, rise)


def thermal_system(
    case: Case,
    bodies: Bodies,
    model: Model,
    pairing: Pairing,
    elastic: Elasticity,
    basis: np.ndarray,
    facing: Facing,
    phases: Phases,
) -> ThermalSystem | None:
    """Assemble and condense conduction; None without heat. Every rank calls."""
    heat = case.heat
    if heat is None:
        return None
    with phases("assemble conduction"):
        space = lagrange_space(bodies.mesh, case.mesh.degree)
        upper, lower = pairing.sides
        traces = (value_trace(space, upper), value_trace(space, lower))
        materials, times = conducting_bodies(case)
        cooling = {surface: times[surface] * h for surface, h in heat.cooling.items()}
        shift = max(_conductivities(case, materials)) / pairing.extent
        given = {
            name: temperature_at(value, 0.0) - heat.ambient
            for name, value in heat.temperature.items()
        }
        bath = bath_matrix(space, traces, pairing.weights, shift)
        passage = _passage(case)
        conducting = conduction(bodies, model, space, materials, cooling, given, bath, passage)
        load = elastic.thermal_load(space)
        loads = thermal_loads(heat, bodies, model, conducting, times)
        conducting, expansions = _varying(case, conducting, bodies, model, elastic, materials)
    with phases("condense conduction"):
        share = partition(case, facing)
        face = condense_heat(conducting, pairing.weights, basis, traces, shift, share)
    diffusivity = max(m.conductivity / (m.capacity or np.inf) for m in materials.values())
    initial = 0.0 if heat.initial is None else heat.initial - heat.ambient
    return ThermalSystem(
        conducting, load, loads, face, heat.ambient, initial, diffusivity, expansions
    )


def _varying(
    case: Case,
    conducting: Conduction,
    bodies: Bodies,
    model: Model,
    elastic: Elasticity,
    materials: dict[str, ThermalMaterial],
) -> tuple[Conduction, tuple[VaryingExpansion, ...]]:
    """Make conductivity and expansion temperature-dependent where the case has tables."""
    assert case.heat is not None
    found = {part: case.material(part) for part in case.geometry.parts}
    conducts = {p: m.conductivity_factor.table for p, m in found.items() if m.conductivity_factor}
    expands = {p: m.expansion_factor.table for p, m in found.items() if m.expansion_factor}
    if not conducts and not expands:
        return conducting, ()
    ambient = case.heat.ambient
    return (
        varying_conduction(conducting, bodies, model, materials, conducts, ambient),
        varying_expansion(elastic, conducting.space, expands, ambient),
    )


def _conductivities(case: Case, materials: dict[str, ThermalMaterial]) -> list[float]:
    """Conductivities of all parts at the ambient temperature, tables included [W/(m K)]."""
    assert case.heat is not None
    factors = [case.material(part).conductivity_factor for part in materials]
    ambient = np.array(case.heat.ambient)
    return [
        material.conductivity * (1.0 if factor is None else float(factor.table.value(ambient)))
        for material, factor in zip(materials.values(), factors, strict=True)
    ]


def _passage(case: Case) -> Passage | None:
    """Motion of body 2 past body 1 for advection; None where conduction neglects it."""
    heat, geometry, motion = case.heat, case.geometry, case.motion
    assert heat is not None
    if heat.advection == "none" or motion is None:
        return None
    parts, center = geometry.parts_of(geometry.bodies[1]), geometry.rotation_center
    one_way = motion.one_way  # body 1 over body 2 along x, or body 2 about a centre
    speed = -(one_way.velocity or 0.0) if center is None else one_way.angular_velocity or 0.0
    return Passage(parts, center, speed, spread=heat.advection == "spread")


def thermal_material(case: Case, part: str) -> ThermalMaterial:
    """Conductivity and heat capacity of a part."""
    material = case.material(part)
    assert material.conductivity is not None  # the case has been checked
    if material.density is None or material.specific_heat is None:
        return ThermalMaterial(material.conductivity)
    return ThermalMaterial(material.conductivity, material.density * material.specific_heat)


def conducting_bodies(case: Case) -> tuple[dict[str, ThermalMaterial], dict[str, float]]:
    """Materials by part and area factors by surface, for the modelled sector.

    All of a rotating body 2 passes under a body 1 that covers a sector and is heated: its whole
    ring conducts, stores and cools.
    """
    geometry = case.geometry
    moving, sector = geometry.bodies[1], geometry.sector
    materials = {part: thermal_material(case, part) for part in geometry.parts}
    for part in geometry.parts_of(moving):
        materials[part] = materials[part].times(1 / sector)
    times = {s: 1 / sector if s.startswith(f"{moving}_") else 1.0 for s in geometry.surfaces}
    return materials, times
