"""Heat conduction in the bodies of a model, and heat exchange at its interfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...bulk.bodies import Bodies
from ...bulk.compiled import surface_area
from ...bulk.elasticity.elasticity import Elasticity, ThermalForces
from ...bulk.heat.advection import Passage, require_swept
from ...bulk.heat.conduction import Conduction
from ...bulk.heat.heat_equation import ThermalMaterial, conduction, given_rises, surface_heat
from ...bulk.heat.paths import EvenPaths
from ...bulk.heat.varying import (
    VaryingConduction,
    VaryingExpansion,
    thermal_forces,
    varying_conduction,
    varying_expansion,
)
from ...bulk.kinematics import Kinematics
from ...bulk.solvers.choice import SolverChoice
from ...bulk.spaces import Spaces, lagrange_spaces
from ...contact.operators.condensation import bath_matrix, condense_heat, face_traces
from ...contact.operators.coupled_heat import CoupledHeat
from ...contact.operators.exchange_matrix import FaceNodes
from ...contact.operators.heat_exchange import FaceHeat, InterfaceHeat
from ...contact.operators.pressure import Basis, functions_by_interface
from ...contact.search.pairing import Contacts, Pairing
from ...contact.ties import thermal_joints
from ...errors import CaseError
from ...laws.histories import TimeFunction
from ...model.conditions import Heat, Motion
from ...model.model import Model
from ...timer import Phases
from ..points.contact_points import facing_parts


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
    fluxes : dict of str to float
        Given heat into the bodies by surface [W/m²].
    """

    base: ThermalLoad
    reference: float
    given: dict[str, tuple[TimeFunction | float, np.ndarray]]
    surroundings: tuple[TimeFunction, np.ndarray] | None
    fluxes: dict[str, float]

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
    fluxes = {surface: power / areas[surface] for surface, power in powers.items()}
    for surface, flux in fluxes.items():
        total += surface_heat(bodies, kinematics, spaces, surface, flux)
    given, surroundings = {}, None
    if any(isinstance(T, TimeFunction) for T in heat.temperature.values()):
        for surface, T in heat.temperature.items():
            unit = {name: float(name == surface) for name in heat.temperature}
            given[surface] = T, given_rises(bodies, spaces, unit, conduction.even)[1]
    if heat.ambient_history is not None:
        surroundings = heat.ambient_history, conduction.per_ambient()
    constant = ThermalLoad(total, sum(powers.values()), sum(map(abs, powers.values())))
    return ThermalLoads(constant, heat.ambient, given, surroundings, fluxes)


_MOST_CONDENSED = 4000
"""Largest number of contact points for which conduction is condensed for a single solution."""


@dataclass(frozen=True)
class ThermalSystem:
    """Conducting bodies, their thermal loads and the heat exchange at the interfaces.

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
    def condensed(self) -> tuple[Conduction, tuple[FaceNodes, ...]]:
        """Conduction, and the nodes of the faces of each body to which it is condensed."""
        assert isinstance(self.face, InterfaceHeat)
        return self.conduction, self.face.nodes

    def straining(self, elastic: Elasticity, load: ThermalForces) -> ThermalSystem:
        """Same conduction, with forces on elastic bodies of another expansion. Every rank calls."""
        spaces = self.conduction.spaces
        expansions = tuple(
            replace(one, matrix=elastic.thermal_load(spaces, only=one.part))
            for one in self.expansions
        )
        return replace(self, load=load, expansions=expansions)

    def forces(self, rise: np.ndarray) -> np.ndarray:
        """Nodal forces of a temperature rise, owned rows [N]."""
        return thermal_forces(self.load, self.expansions, rise)


def thermal_system(
    model: Model,
    heat: Heat,
    contacts: Contacts,
    glued: Sequence[Pairing],
    elastic: Elasticity,
    spaces: Spaces,
    basis: Basis,
    partition: np.ndarray,
    phases: Phases,
    choice: SolverChoice,
) -> ThermalSystem:
    """Assemble conduction, and condense it if need be. Every rank calls."""
    bodies, kinematics = elastic.bodies, elastic.kinematics
    with phases("assemble conduction"):
        traces = face_traces(spaces, contacts)
        materials = conducting_parts(model)
        shifts = _shifts(model, heat, contacts, materials)
        given = {
            name: temperature_at(value, 0.0) - heat.ambient
            for name, value in heat.temperature.items()
        }
        conductances = [
            np.inf if tie.conductance is None else tie.conductance * model.ring(tie.faces[0])
            for tie in model.ties
        ]
        bath = bath_matrix(spaces, traces, contacts.weights, shifts)
        conducting = conduction(
            bodies,
            kinematics,
            spaces,
            materials,
            cooling(model, heat),
            given,
            bath,
            _passage(model, heat, contacts),
            choice,
            joints=thermal_joints(spaces, glued, conductances),
        )
        load = elastic.thermal_load(spaces)
        loads = thermal_loads(model, heat, bodies, kinematics, conducting)
        conducting, expansions = _varying(model, heat, conducting, elastic, materials)
    face: InterfaceHeat | CoupledHeat
    functions = functions_by_interface(contacts, basis)
    layers = shifts[0] * functions, shifts[1] * functions
    at_points = contacts.weights, basis, traces, shifts, layers, partition
    if coupled_without_condensation(choice, len(contacts.weights)):
        face = CoupledHeat(*at_points, conducting)
    else:
        face = condense_heat(conducting, FaceHeat(*at_points))
    diffusivity = max(m.conductivity / (m.capacity or np.inf) for m in materials.values())
    initial = 0.0 if heat.initial is None else heat.initial - heat.ambient
    return ThermalSystem(
        conducting, load, loads, face, heat.ambient, initial, diffusivity, expansions
    )


def heat_partition(model: Model, bodies: Bodies, contacts: Contacts) -> np.ndarray:
    """Fraction of the friction heat released into the first body, shape (n,). Every rank calls."""
    result = np.empty(len(contacts.weights))
    for interface, (pairing, points) in zip(model.interfaces, contacts, strict=True):
        facing = facing_parts(bodies, pairing)
        result[points] = interface.heat_partition(facing, model.materials)
    return result


def _shifts(
    model: Model, heat: Heat, contacts: Contacts, materials: dict[str, ThermalMaterial]
) -> tuple[np.ndarray, np.ndarray]:
    """Heat transfer of both faces to the bath at the points, shape (n,) each [W/(m² K)].

    Conductivity of the body over the size of the face that carries the pressure: by its area, as
    imperfect contact is divided by it and must not depend on the place or order of the bodies.
    """
    conductivities = _conductivities(model, heat, materials)
    faces = [pairing.carrying.face for pairing in contacts.each]
    sizes = [face.sizes.sum() ** (1 / face.dim) for face in faces]
    first, second = (
        contacts.per_point(
            [
                conductivities[pair[side]] / size
                for size, pair in zip(sizes, contacts.bodies, strict=True)
            ]
        )
        for side in (0, 1)
    )
    return first, second


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


def _passage(model: Model, heat: Heat, contacts: Contacts) -> Passage | None:
    """Motion of the body that passes the others, for advection; None where conduction neglects it.

    Raises
    ------
    CaseError
        If there are several such bodies, others are glued to it, or it turns about another axis.
    """
    moving = [one for one in model.interfaces if not one.motion.at_rest]
    if heat.advection == "none" or not moving:
        return None
    found = {
        (one.bodies[one.motion.moving_side], one.motion.center, _passing_speed(one.motion))
        for one in moving
    }
    if len(found) > 1:
        raise CaseError(
            "heat.advection: several bodies pass others; heat can be carried along by one only"
        )
    if not all(one.motion.passes for one in moving):
        raise CaseError(
            "heat.advection: is for one body that passes the others along x, or turning about z; "
            'use "none"'
        )
    if heat.advection == "resolved" and any(one.motion.history for one in moving):
        raise CaseError(
            'heat.advection: "resolved" needs a constant speed, without a history of the motion'
        )
    ((body, center, speed),) = found
    glued = [k for group in model.groups if body in group for k in group if k != body]
    if glued:
        raise CaseError(
            f"heat.advection: {model.bodies[glued[0]].name} is glued to {model.bodies[body].name}, "
            'which passes others; heat can be carried along by one body only; use "none"'
        )
    x = np.concatenate(
        [
            pairing.points[:, 0]
            for pairing, one in zip(contacts.each, model.interfaces, strict=True)
            if body in one.bodies
        ]
    )
    contact = float(x.min()), float(x.max())
    return Passage(model.bodies[body].parts, center, speed, heat.advection == "spread", contact)


def require_passing(model: Model, bodies: Bodies, contacts: Contacts) -> None:
    """Require a body that carries heat along to keep its shape in the frame. Every rank calls.

    Raises
    ------
    CaseError
    """
    heat = model.heat
    passage = None if heat is None else _passage(model, heat, contacts)
    if passage is None:
        return
    own = next(body for body in model.bodies if body.parts == passage.parts)
    of_kind = [(m.conductivity, m.conductivity_factor, m.capacity) for m in own.materials.values()]
    kinds = {part: of_kind.index(kind) for part, kind in zip(own.parts, of_kind, strict=True)}
    require_swept(bodies, passage, kinds, (*model.symmetry, *own.rollers))
    if passage.spread:
        EvenPaths(bodies, lagrange_spaces(bodies, 1), passage)  # needs rows of cells


def _passing_speed(motion: Motion) -> float:
    """Velocity of the moving body [m/s], or its angular velocity about a centre [rad/s]."""
    of_second = -(motion.velocity or 0.0) if motion.center is None else motion.angular_velocity
    return of_second or 0.0 if motion.moving_side == 1 else -(of_second or 0.0)


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
