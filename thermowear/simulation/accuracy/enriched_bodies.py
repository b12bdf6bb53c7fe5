"""Change of a state by elements of the next degree (hierarchical enrichment of the bodies).

Contact pressure and friction heat of the state are kept; compliance and temperature of the bodies
change with the better discretisation.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy.sparse as sp

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
from ...contact.operators.condensation import face_traces, gap_trace, vector_trace
from ...contact.operators.exchange_matrix import BaselineResponse
from ...contact.operators.heat_exchange import InterfaceHeat
from ...contact.operators.pressure import dense, scaled
from ...model.conditions import Heat
from ...parallel import sum_over_ranks
from ..heat.friction_heat import TemperatureField
from ..interface.body_state import BodyState, ContactState
from ..system.rigid_modes import fluid_pressure, surface_loads
from ..system.system import System
from ..system.thermal_system import ThermalSystem, conducting_parts, cooling

_LAYERS = 2
"""Layers of cells in space that have a surplus."""


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
    near : list of ndarray or None
        See `near_contact`.
    """

    def __init__(self, system: System, near: list[np.ndarray] | None):
        elastic, degree = system.elastic, system.model.discretisation.degree
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
                (partial(body.virtual_work, degree=_gradients(self._degree, near)),)
                for body in elastic.each
            ],
            _solver(system, elastic.solve),
            (elastic.fixed, np.concatenate(held)),
            near=near,
        )
        self._trace = sp.vstack([system.trace, gap_trace(surplus, system.contacts)])

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
            bodies = zip(system.elastic.each, rises, strict=True)
            works = [partial(b.thermal_work, rise, degree=self._degree) for b, rise in bodies]
            loads = loads + problem.surplus.loads(works)
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
        loads = vector_trace(problem.surplus, system.contacts, traction) @ system.weights
        for works in surface_loads(system.model, system.elastic):
            loads = loads + problem.surplus.loads(works)
        return loads


def _gradients(degree: int, near: list[np.ndarray] | None) -> int:
    """Degree for the quadrature of products of gradients, which have one degree less.

    Not in a section, whose radii are in it, too.
    """
    return degree if near is None else degree - 1


def _solver(system: System, solve: Callable) -> Callable[[np.ndarray], np.ndarray]:
    """Solver for corrections on the space; none where each takes as long as that of the state."""
    return np.zeros_like if system.choice.iterative else solve


def near_contact(system: System) -> list[np.ndarray] | None:
    """Cells at the contacts, to which the next degree is restricted in space; None in a section.

    There it would cost more than the solution. Errors elsewhere reach the contact as a change that
    varies little along it.
    """
    if system.bodies.dim == 2:
        return None
    faces = [name for interface in system.model.interfaces for name in interface.faces]
    return cells_near(system.bodies, faces, _LAYERS)


def temperature_change(
    system: System,
    heat: Heat,
    thermal: ThermalSystem,
    temperatures: TemperatureField,
    conductance: np.ndarray,
    time: float,
    near: list[np.ndarray] | None,
) -> TemperatureChange:
    """Change of temperatures by the next degree for a given friction heat; collective.

    Of temperatures that change in time, the change that steady conduction has for the rate of heat
    storage of the solution: the elliptic reconstruction of Makridakis and Nochetto (SIAM J. Numer.
    Anal. 41 (2003) 1585).
    """
    conduction, face = thermal.conduction, thermal.face
    problem = _conducting(system, heat, thermal, near)
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


def _conducting(
    system: System, heat: Heat, thermal: ThermalSystem, near: list[np.ndarray] | None
) -> EnrichedProblem:
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
            conducting(body, kinematics, conductivities, _gradients(degree, near)),
            *transferring(body, kinematics, given_h),
        ]
        corrected = transferring(body, kinematics, shifts)
        flow = None if advection is None else advection.flows[index]
        if flow is not None:
            own.append(partial(flow.carried, degree=degree))
            corrected.append(partial(flow.upwind_diffusion, degree=degree))
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
        near=near,
    )


def _passes(conduction: Conduction, index: int) -> bool:
    """Test whether this rank has values on paths of a body."""
    assert conduction.even is not None
    return bool((conduction.even.numbers[conduction.spaces.rows(index)] >= 0).any())
