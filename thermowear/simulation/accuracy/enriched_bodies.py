"""Change of a state by elements of the next degree (hierarchical enrichment of the bodies).

Contact pressure and friction heat of the state are kept; compliance and temperature of the bodies
change with the better discretisation.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy.sparse as sp
import ufl

from ...bulk.bodies import BodyMesh
from ...bulk.elasticity.elasticity import fixed_values
from ...bulk.elasticity.enriched import EnrichedProblem, cells_near, surplus_spaces
from ...bulk.heat.conduction import Conduction
from ...bulk.heat.heat_equation import (
    conducting,
    given_rises,
    stored_heat_rates,
    surface_heat,
    transferring,
)
from ...bulk.kinematics import section_measure
from ...compat import exterior_facet_domain
from ...contact.operators.condensation import component_traces, face_traces, in_directions
from ...contact.operators.exchange_matrix import BaselineResponse
from ...contact.operators.heat_exchange import InterfaceHeat
from ...contact.operators.pressure import dense, scaled
from ...contact.search.pairing import PairedFace
from ...model.conditions import Heat
from ...parallel import sum_over_ranks
from ..heat.friction_heat import TemperatureField
from ..interface.body_state import BodyState, ContactState
from ..system.rigid_modes import fluid_pressure, surface_loads
from ..system.system import System
from ..system.thermal_system import ThermalSystem, conducting_parts, cooling

_LAYERS = 2
"""Layers of cells in space that have a surplus.

Temperatures need one only from degree 2 on: details stay at the face, but bodies bend as a whole.
"""


@dataclass(frozen=True)
class TemperatureChange:
    """Change of the temperatures by the next degree.

    Attributes
    ----------
    faces : ndarray, shape (2, n)
        Change at the points of both faces [K].
    rises : list of UFL expression
        Rise in each body including the change [K].
    """

    faces: np.ndarray
    rises: list[Any]


class EnrichedBodies:
    """Elastic bodies of a system with the surplus space of the next degree. Every rank calls.

    Parameters
    ----------
    system : System
    """

    def __init__(self, system: System):
        elastic, degree = system.elastic, system.model.discretisation.degree
        near = _near_contact(system, _LAYERS, elastic.joints.surfaces)
        bodies = elastic.bodies
        surplus = surplus_spaces(bodies, degree, bodies.dim)
        clamped, *guided = system.model.supports
        clamped = (*clamped, *elastic.joints.surfaces)  # the details at a joint are not resolved
        held = [
            fixed_values(body, elastic.kinematics, space, clamped, guided)
            for body, space in zip(bodies.each, surplus.each, strict=True)
        ]
        self._system = system
        self._degree = degree + 1
        self._problem = EnrichedProblem(
            elastic.spaces,
            surplus,
            [
                (partial(body.virtual_work, measure=_measure(body.body, self._degree, 2)),)
                for body in elastic.each
            ],
            _solver(system, elastic.solve),
            (elastic.fixed, np.concatenate(held)),
            near=near,
        )
        self._components = component_traces(surplus, system.contacts)
        details = in_directions(self._components, system.contacts.normals)
        self._trace = sp.vstack([system.trace, details])

    def opening(self, contact: ContactState, state: BodyState, heated: TemperatureChange | None):
        """Change of the gap at the points by the next degree in a state, shape (n,) [m]."""
        system, problem, thermal = self._system, self._problem, self._system.thermal
        loads, before = self._loads(contact), state.temperatures
        more = np.zeros(problem.spaces.owned)
        if before is not None and thermal is not None:
            if heated is None:
                rises = thermal.conduction.spaces.functions(before.rise, "rise")
            else:
                rises = heated.rises
            works = [
                partial(b.thermal_work, rise, measure=_measure(b.body, self._degree, 1))
                for b, rise in zip(system.elastic.each, rises, strict=True)
            ]
            loads = loads + problem.surplus_loads(works)
            if heated is not None:
                more = problem.spaces.loads(works) - thermal.forces(before.rise)
        residual = problem.residual(problem.field(state.displacement), loads, more)
        return self._gap(problem.correction(residual))

    def answer(self, pressure: np.ndarray) -> np.ndarray:
        """Approximate gap opened by a pressure at the points, shape (n,) [m]."""
        nodal = self._trace @ (self._system.weights * pressure)
        return self._gap(self._problem.approximate(nodal))

    def _gap(self, field: np.ndarray) -> np.ndarray:
        return sum_over_ranks(self._system.comm, self._trace.T @ field)

    def _loads(self, contact: ContactState) -> np.ndarray:
        """Loads of the contact, fluid and surface loads on the surplus."""
        system, problem = self._system, self._problem
        traction = contact.traction(system.with_friction(contact.conditions.friction))
        fluid = fluid_pressure(system.model, system.contacts)
        if fluid is not None:
            traction = traction + fluid[:, None] * system.contacts.normals
        forces = (system.weights[:, None] * traction).T
        parts = zip(self._components, forces, strict=True)
        loads = np.sum([component @ force for component, force in parts], axis=0)
        for works in surface_loads(system.model, system.elastic):
            loads = loads + problem.surplus_loads(works)
        return loads


def _measure(body: BodyMesh, degree: int, derivatives: int) -> ufl.Measure:
    """Measure for products of two functions of a degree, of which some are derivatives.

    In space exact on straight cells; not in a section, whose radii are in it, too.
    """
    if body.mesh.topology.dim == 2:
        return section_measure(body.mesh, degree)
    return ufl.dx(metadata={"quadrature_degree": 2 * degree - derivatives})


def _solver(system: System, solve: Callable) -> Callable[[np.ndarray], np.ndarray]:
    """Solver for corrections on the space; none where each takes as long as that of the state."""
    return np.zeros_like if system.choice.iterative else solve


def _near_contact(
    system: System, layers: int, glued: Sequence[str] = ()
) -> list[np.ndarray] | None:
    """Cells at the contact points, to which the next degree is restricted in space; None in plane.

    Elsewhere it would cost more than the solution. Errors there, also in other parts of a face such
    as the track of a brake pad, reach the contact as a change that varies little along it; but not
    those of bodies behind it, such as back plates, of which glued faces are given.
    """
    bodies = system.bodies
    if bodies.dim == 2:
        return None
    sides = [side for pairing in system.contacts.each for side in pairing.sides]
    facets = []
    for index, body in enumerate(bodies.each):
        own = [_local_facets(side, system.comm.rank) for side in sides if side.face.body == index]
        if not own:
            behind = [body.facets(surface) for surface in glued]
            own = [exterior_facet_domain(body.mesh, f).reshape(-1, 2).T for f in behind]
        facets.append(np.concatenate([np.empty((2, 0), dtype=np.int64), *own], axis=1))
    return cells_near(bodies, facets, layers)


def _local_facets(side: PairedFace, rank: int) -> np.ndarray:
    """Cells of a rank at the points of a face and their local facets, shape (2, n_facets)."""
    face, touched = side.face, np.unique(side.facet)
    touched = touched[face.rank[touched] == rank]
    return np.array([face.cell[touched], face.local_facet[touched]])


def temperature_change(
    system: System,
    heat: Heat,
    thermal: ThermalSystem,
    temperatures: TemperatureField,
    conductance: np.ndarray,
    time: float,
) -> TemperatureChange:
    """Change of temperatures by the next degree for a given friction heat; collective.

    Of temperatures that change in time, the change that steady conduction has for the rate of heat
    storage of the solution: the elliptic reconstruction of Makridakis and Nochetto (SIAM J. Numer.
    Anal. 41 (2003) 1585).
    """
    conduction, face = thermal.conduction, thermal.face
    problem = _conducting(system, heat, thermal)
    details = face_traces(problem.surplus, system.contacts)
    traces = [sp.vstack(both) for both in zip(face.traces, details, strict=True)]
    fluxes = zip(details, temperatures.faces.flux, strict=True)
    loads = sum(trace @ (face.weights * flux) for trace, flux in fluxes)
    loads = loads + _other_heat(system, heat, thermal, problem, temperatures, time)
    before, count = problem.field(temperatures.rise), problem.spaces.owned
    residual = problem.residual(before, loads, np.zeros(count))
    change = problem.correction(residual)
    uncoupled = np.array([sum_over_ranks(system.comm, trace.T @ change) for trace in traces])
    if heat.transient or system.choice.iterative or not isinstance(face, InterfaceHeat):
        rises = _levelled(uncoupled, 1 / np.array(face.layers), conductance)
        return TemperatureChange(rises, problem.functions(before + change))
    # the nodal space cannot represent the response to a flux that levels finer details
    weighted = scaled(face.weights, face.basis)
    mass = dense(weighted.T @ face.basis)
    resolved = face.basis @ np.linalg.lstsq(mass, weighted.T @ uncoupled.T, rcond=None)[0]
    exchange = face.exchange(conductance)
    none = np.zeros(len(face.weights))
    coupled = exchange.state(none, BaselineResponse((resolved[:, 0], resolved[:, 1])))
    change[:count] += conduction.respond(face.nodal_heat(coupled, bath=True))
    finer = _levelled(uncoupled - resolved.T, _own_resistances(face), conductance)
    return TemperatureChange(np.array(coupled.rise) + finer, problem.functions(before + change))


def heated_faces(
    system: System, thermal: ThermalSystem, friction_heat: np.ndarray, conductance: np.ndarray
) -> np.ndarray:
    """Rises of both faces by steady conduction of a change of the friction heat (2, n) [K].

    The heat, shape (n,) [W/m²], is one of details: that of the mean is given. Every rank calls.
    """
    face = thermal.face
    heat = face.partition * friction_heat
    fluxes = zip(face.traces, (heat, friction_heat - heat), strict=True)
    field = thermal.conduction.respond(sum(trace @ (face.weights * flux) for trace, flux in fluxes))
    rises = np.array([sum_over_ranks(system.comm, trace.T @ field) for trace in face.traces])
    return _levelled(rises, 1 / np.array(face.layers), conductance)


def _other_heat(
    system: System,
    heat: Heat,
    thermal: ThermalSystem,
    problem: EnrichedProblem,
    temperatures: TemperatureField,
    time: float,
) -> np.ndarray:
    """Heat to the surplus from surfaces, surroundings and storage, owned values [W]."""
    model, kinematics, spaces = system.model, system.elastic.kinematics, problem.surplus
    load = thermal.loads.at(time)
    loads = np.zeros(spaces.owned)
    for surface, flux in thermal.loads.fluxes.items():
        loads += surface_heat(system.bodies, kinematics, spaces, surface, flux)
    for surface, coefficient in cooling(model, heat).items():
        if load.ambient:
            flux = coefficient * load.ambient
            loads += surface_heat(system.bodies, kinematics, spaces, surface, flux)
    if heat.transient:
        nodal = thermal.face.nodal_heat(temperatures.faces, bath=False) + load.heat
        rate = thermal.conduction.storage_rate(temperatures.rise, nodal)
        rates = thermal.conduction.spaces.functions(rate, "rate")
        parts = conducting_parts(model)
        loads -= stored_heat_rates(system.bodies, kinematics, spaces, parts, rates)
    return loads


def _own_resistances(face: InterfaceHeat) -> np.ndarray:
    """Rise of each face at each point per own flux there, shape (2, n) [m² K/W]."""
    own = np.zeros((2, len(face.weights)))
    for nodes, response in zip(face.nodes, face.response, strict=True):
        own += [values.multiply(values @ response).sum(axis=1) for values in nodes.values]
    return np.abs(face.weights * own)


def _levelled(rises: np.ndarray, own: np.ndarray, conductance: np.ndarray) -> np.ndarray:
    """Rises of both faces (2, n) below the nodal resolution after their exchange of heat [K].

    Approximation: each point has a resistance of its own in either body, shape (2, n) [m² K/W].
    """
    with np.errstate(divide="ignore"):
        resistance = own.sum(axis=0) + 1 / conductance  # none where both temperatures are given
    share = np.divide(own, resistance, out=np.zeros_like(own), where=resistance > 0.0)
    return rises + share * (rises[1] - rises[0]) * np.array([[1.0], [-1.0]])


def _conducting(system: System, heat: Heat, thermal: ThermalSystem) -> EnrichedProblem:
    """Conduction with its surplus space; corrections transfer heat to a bath at both faces."""
    conduction, model, bodies = thermal.conduction, system.model, system.bodies
    degree, kinematics = model.discretisation.degree + 1, system.elastic.kinematics
    conductivities = {part: m.conductivity for part, m in conducting_parts(model).items()}
    surplus, given_h = surplus_spaces(bodies, degree - 1), cooling(model, heat)
    shifts = {
        name: float(shift[points.start])
        for interface, points in zip(model.interfaces, system.contacts.ranges, strict=True)
        for name, shift in zip(interface.faces, thermal.face.shifts, strict=True)
    }
    left_out = *heat.temperature, *conduction.joints.surfaces
    given, _ = given_rises(bodies, surplus, dict.fromkeys(left_out, 0.0), None)
    advection, even = conduction.advection, conduction.even
    terms, only_corrections = [], []
    for index, body in enumerate(bodies.each):
        own = [
            conducting(body, kinematics, conductivities, _measure(body, degree, 2)),
            *transferring(body, kinematics, given_h),
        ]
        corrected = transferring(body, kinematics, shifts)
        flow = None if advection is None else advection.flows[index]
        if flow is not None:
            measure = _measure(body, degree, 0)  # the velocity is linear
            own.append(partial(flow.carried, measure=measure))
            corrected.append(partial(flow.upwind_diffusion, measure=measure))
        if even is not None and any(system.comm.allgather(_passes(conduction, index))):
            given[surplus.rows(index)] = True  # no details along paths of even temperature
        terms.append(own)
        only_corrections.append(corrected)
    return EnrichedProblem(
        conduction.spaces,
        surplus,
        terms,
        _solver(system, conduction.respond),
        (conduction.fixed, given),
        only_corrections,
        symmetric=advection is None,
        near=_near_contact(system, 1 if degree > 2 else _LAYERS),
    )


def _passes(conduction: Conduction, index: int) -> bool:
    """Test whether this rank has values on paths of a body."""
    assert conduction.even is not None
    return bool((conduction.even.numbers[conduction.spaces.rows(index)] >= 0).any())
