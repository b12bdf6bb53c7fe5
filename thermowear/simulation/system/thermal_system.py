"""Heat conduction in the bodies of a model, its thermal loads, and heat exchange at the contact."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...bulk.bodies import Bodies
from ...bulk.compiled import surface_area
from ...bulk.heat.advection import Passage
from ...bulk.heat.conduction import Conduction
from ...bulk.heat.heat_equation import ThermalMaterial, conduction, given_rises, surface_heat
from ...bulk.heat.varying import (
    VaryingConduction,
    VaryingExpansion,
    thermal_forces,
    varying_conduction,
    varying_expansion,
)
from ...bulk.kinematics import Kinematics
from ...bulk.mechanics.elasticity import Elasticity
from ...bulk.mechanics.thermal_forces import ThermalForces
from ...bulk.solver_choice import SolverChoice
from ...bulk.spaces import lagrange_spaces
from ...contact.operators.condensation import bath_matrix, condense_heat
from ...contact.operators.coupled_heat import CoupledHeat
from ...contact.operators.face_nodes import FaceNodes
from ...contact.operators.heat_exchange import FaceHeat, InterfaceHeat
from ...contact.operators.traces import value_trace
from ...contact.search.pairing import Pairing
from ...laws.time_course import TimeFunction
from ...model.conditions import Heat
from ...model.model import Model
from ...timer import Phases

_MOST_CONDENSED = 4000
"""Largest number of contact points for which conduction is condensed for a single solution."""


@dataclass(frozen=True)
class ThermalLoad:
    """Thermal loads at one time.

    Attributes
    ----------
    heat : ndarray, shape (n_owned,)
        Nodal heat: prescribed, and from surroundings at other than the ambient temperature of the
        model [W].
    prescribed : float
        Heat into the bodies through surfaces with a given flux or power [W].
    magnitude : float
        Sum of the magnitudes of that heat [W].
    ambient : float
        Rise of the surroundings over the ambient temperature of the model [K].
    given : ndarray or None, shape (n_owned,)
        Prescribed rises at the fixed nodes, zero elsewhere; None: those of the conduction [K].
    """

    heat: np.ndarray
    prescribed: float
    magnitude: float
    ambient: float = 0.0
    given: np.ndarray | None = None


@dataclass(frozen=True)
class ThermalLoads:
    """Thermal loads beside friction as functions of time.

    Attributes
    ----------
    base : ThermalLoad
        Loads constant in time.
    reference : float
        Ambient temperature of the model [K].
    given : dict of str to (TimeFunction or float, ndarray)
        Prescribed temperatures by surface, with the nodal rises (n_owned,) per unit rise of it;
        empty if all are constant.
    surroundings : tuple or None
        Temperature history of the surroundings, and nodal heat (n_owned,) per rise of it [W/K].
    """

    base: ThermalLoad
    reference: float
    given: dict[str, tuple[TimeFunction | float, np.ndarray]]
    surroundings: tuple[TimeFunction, np.ndarray] | None

    @cached_property
    def constant(self) -> ThermalLoad | None:
        """Loads at all times; None if they change."""
        return None if self.given or self.surroundings is not None else self.base

    def at(self, time: float) -> ThermalLoad:
        """Thermal loads at a time [s]."""
        load = self.base
        if self.surroundings is not None:
            history, per_rise = self.surroundings
            above = history.at(time) - self.reference
            load = replace(load, heat=load.heat + above * per_rise, ambient=above)
        if self.given:
            rises = ((temperature_at(T, time) - self.reference) * n for T, n in self.given.values())
            load = replace(load, given=sum(rises, np.zeros(len(load.heat))))
        return load


@dataclass(frozen=True)
class ThermalSystem:
    """Conducting bodies, their thermal loads and the heat exchange at the interface.

    Attributes
    ----------
    conduction : Conduction
    load : ThermalForces
        G: nodal forces per nodal rise [N/K].
    loads : ThermalLoads
        Thermal loads beside friction.
    face : InterfaceHeat or CoupledHeat
        The latter for many contact points or multigrid, where a single solution is needed.
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
    load: ThermalForces
    loads: ThermalLoads
    face: InterfaceHeat | CoupledHeat
    ambient: float
    initial: float
    diffusivity: float
    expansions: tuple[VaryingExpansion, ...]

    @property
    def varies(self) -> bool:
        """True if conductivity or expansion depend on temperature."""
        return isinstance(self.conduction, VaryingConduction)

    @property
    def load_matrices(self) -> list[ThermalForces]:
        """Nodal forces per nodal rise [N/K]: of all bodies, then of each varying expansion."""
        return [self.load, *(expansion.matrix for expansion in self.expansions)]

    @property
    def condensed(self) -> tuple[Conduction, tuple[FaceNodes, FaceNodes]]:
        """Conduction, and the nodes of the faces to which it is condensed."""
        assert isinstance(self.face, InterfaceHeat)
        return self.conduction, self.face.nodes

    def forces(self, rise: np.ndarray) -> np.ndarray:
        """Nodal forces of a temperature rise, owned rows [N]."""
        return thermal_forces(self.load, self.expansions, rise)


def thermal_system(
    model: Model,
    heat: Heat,
    pairing: Pairing,
    elastic: Elasticity,
    basis: np.ndarray,
    partition: float | np.ndarray,
    phases: Phases,
    choice: SolverChoice,
) -> ThermalSystem:
    """Assemble conduction, and condense it if need be. Every rank calls."""
    bodies, kinematics = elastic.bodies, elastic.kinematics
    with phases("assemble conduction"):
        spaces = lagrange_spaces(bodies, model.discretisation.degree)
        upper, lower = pairing.sides
        traces = (value_trace(spaces, upper), value_trace(spaces, lower))
        materials = conducting_parts(model)
        first, second = _conductivities(model, heat, materials)
        shifts = first / pairing.extent, second / pairing.extent
        given = {
            name: temperature_at(value, 0.0) - heat.ambient
            for name, value in heat.temperature.items()
        }
        bath = bath_matrix(spaces, traces, pairing.weights, shifts)
        conducting = conduction(
            bodies,
            kinematics,
            spaces,
            materials,
            cooling(model, heat),
            given,
            bath,
            _passage(model, heat),
            choice,
        )
        load = elastic.thermal_load(spaces)
        loads = thermal_loads(model, heat, bodies, kinematics, conducting)
        conducting, expansions = _varying(model, heat, conducting, elastic, materials)
    face: InterfaceHeat | CoupledHeat
    at_points = pairing.weights, basis, traces, shifts, partition
    if coupled_without_condensation(choice, len(pairing.weights)):
        face = CoupledHeat(*at_points, conducting)
    else:
        face = condense_heat(conducting, FaceHeat(*at_points))
    diffusivity = max(m.conductivity / (m.capacity or np.inf) for m in materials.values())
    initial = 0.0 if heat.initial is None else heat.initial - heat.ambient
    return ThermalSystem(
        conducting, load, loads, face, heat.ambient, initial, diffusivity, expansions
    )


def coupled_without_condensation(choice: SolverChoice, points: int) -> bool:
    """Test whether heat exchange is solved for one state of the contact, without condensation."""
    return choice.single and (choice.iterative or points > _MOST_CONDENSED)


def _varying(
    model: Model,
    heat: Heat,
    conducting: Conduction,
    elastic: Elasticity,
    materials: dict[str, ThermalMaterial],
) -> tuple[Conduction, tuple[VaryingExpansion, ...]]:
    """Make conductivity and expansion temperature-dependent where materials have tables."""
    found, ambient = model.materials.items(), heat.ambient
    conducts = {p: m.conductivity_factor for p, m in found if m.conductivity_factor is not None}
    expands = {p: m.expansion_factor for p, m in found if m.expansion_factor is not None}
    if not conducts and not expands:
        return conducting, ()
    return (
        varying_conduction(
            conducting, elastic.bodies, elastic.kinematics, materials, conducts, ambient
        ),
        varying_expansion(elastic, conducting.spaces, expands, ambient),
    )


def _conductivities(model: Model, heat: Heat, materials: dict[str, ThermalMaterial]) -> list[float]:
    """Largest conductivity of each body at the ambient temperature, tables included [W/(m K)]."""
    factors = {part: model.materials[part].conductivity_factor for part in materials}
    at_ambient = {
        part: 1.0 if factor is None else float(factor.value(heat.ambient))
        for part, factor in factors.items()
    }
    return [
        max(materials[part].conductivity * at_ambient[part] for part in body.parts)
        for body in model.bodies
    ]


def _passage(model: Model, heat: Heat) -> Passage | None:
    """Motion of body 2 past body 1 for advection; None where conduction neglects it."""
    motion = model.motion
    if heat.advection == "none" or motion.at_rest:
        return None
    # body 1 over body 2 along x, or body 2 about a centre
    speed = -(motion.velocity or 0.0) if motion.center is None else motion.angular_velocity or 0.0
    return Passage(model.bodies[1].parts, motion.center, speed, spread=heat.advection == "spread")


def conducting_parts(model: Model) -> dict[str, ThermalMaterial]:
    """Conductivity and heat capacity by part, of whole rings where these pass the contact."""
    why = "needed because the model has heat"
    return {
        part: ThermalMaterial(m.known("conductivity", why), m.capacity).times(ring)
        for body in model.bodies
        for ring in [body.ring]
        for part, m in body.materials.items()
    }


def cooling(model: Model, heat: Heat) -> dict[str, float]:
    """Heat transfer coefficients by surface, of whole rings likewise [W/(m² K)]."""
    return {surface: model.ring(surface) * h for surface, h in heat.cooling.items()}


def temperature_at(given: TimeFunction | float, time: float) -> float:
    """Prescribed temperature [K] at a time [s]."""
    return given.at(time) if isinstance(given, TimeFunction) else given


def thermal_loads(
    model: Model, heat: Heat, bodies: Bodies, kinematics: Kinematics, conduction: Conduction
) -> ThermalLoads:
    """Assemble the thermal loads of a model with heat. Every rank calls."""
    spaces = conduction.spaces
    total = np.zeros(len(conduction.fixed))
    areas = {s: surface_area(bodies, kinematics, s) for s in (*heat.flux, *heat.power)}
    powers = {s: q * model.ring(s) * areas[s] for s, q in heat.flux.items()} | dict(heat.power)
    for surface, power in powers.items():
        total += surface_heat(bodies, kinematics, spaces, surface, power / areas[surface])
    given, surroundings = {}, None
    if any(isinstance(T, TimeFunction) for T in heat.temperature.values()):
        for surface, T in heat.temperature.items():
            unit = {name: float(name == surface) for name in heat.temperature}
            given[surface] = T, given_rises(bodies, spaces, unit, conduction.even)[1]
    if heat.ambient_history is not None:
        surroundings = heat.ambient_history, conduction.per_ambient()
    constant = ThermalLoad(total, sum(powers.values()), sum(map(abs, powers.values())))
    return ThermalLoads(constant, heat.ambient, given, surroundings)
