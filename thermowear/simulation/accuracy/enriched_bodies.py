"""Change of a state by elements of the next degree (hierarchical enrichment of the bodies).

Contact pressure and friction heat of the state are kept; compliance and temperature of the bodies
change with the better discretisation.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy.sparse as sp

from ...bulk.heat.heat_equation import conducting, given_rises, transferring
from ...bulk.mechanics.elasticity import fixed_values
from ...bulk.mechanics.enriched import EnrichedProblem
from ...bulk.mechanics.surplus import surplus_spaces
from ...contact.operators.heat import BaselineResponse
from ...contact.operators.heat_exchange import InterfaceHeat
from ...contact.operators.pressure import dense, scaled
from ...contact.operators.traces import face_traces, gap_trace, vector_trace
from ...model.conditions import Heat
from ...parallel import sum_over_ranks
from ..heat.friction_heat import TemperatureField
from ..interface.body_state import BodyState
from ..interface.equilibrium import ContactState
from ..system.rigid_modes import fluid_pressure, surface_loads
from ..system.system import System
from ..system.thermal_system import ThermalSystem, conducting_parts, cooling


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
    """Elastic bodies of a system with the surplus space of the next degree. Every rank calls."""

    def __init__(self, system: System):
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
            [(partial(body.virtual_work, degree=self._degree),) for body in elastic.each],
            elastic.solve,
            (elastic.fixed, np.concatenate(held)),
        )
        self._trace = sp.vstack([system.trace, gap_trace(surplus, system.contacts)])

    def opening(self, contact: ContactState, state: BodyState, heated: TemperatureChange | None):
        """Change of the gap at the points by the next degree in a state, shape (n,) [m]."""
        system, problem = self._system, self._problem
        loads, thermal, before = self._loads(contact), system.thermal, state.temperatures
        if heated is not None:
            bodies = zip(system.elastic.each, heated.rises, strict=True)
            works = [partial(b.thermal_work, rise, degree=self._degree) for b, rise in bodies]
            loads = loads + problem.loads(works)
        elif before is not None and thermal is not None:
            loads[: problem.spaces.owned] += thermal.forces(before.rise)
        residual = problem.residual(problem.field(state.displacement), loads)
        return self._gap(problem.correction(residual))

    def answer(self, pressure: np.ndarray) -> np.ndarray:
        """Approximate gap opened by a pressure at the points, shape (n,) [m]."""
        nodal = self._trace @ (self._system.weights * pressure)
        return self._gap(self._problem.approximate(nodal))

    def _gap(self, field: np.ndarray) -> np.ndarray:
        return sum_over_ranks(self._system.comm, self._trace.T @ field)

    def _loads(self, contact: ContactState) -> np.ndarray:
        """Nodal loads of the contact, fluid and surface loads in the enriched space."""
        system, problem = self._system, self._problem
        traction = contact.traction(system.with_friction(contact.conditions.friction))
        fluid = fluid_pressure(system.model, system.contacts)
        if fluid is not None:
            traction = traction + fluid[:, None] * system.contacts.normals
        loads = np.concatenate(
            [
                vector_trace(space, system.contacts, traction) @ system.weights
                for space in (problem.spaces, problem.surplus)
            ]
        )
        for holder in system.model.holders:
            for works in surface_loads(holder, system.elastic):
                loads = loads + problem.loads(works)
        return loads


def temperature_change(
    system: System,
    heat: Heat,
    thermal: ThermalSystem,
    temperatures: TemperatureField,
    conductance: np.ndarray,
) -> TemperatureChange:
    """Change of steady temperatures by the next degree for a given friction heat; collective."""
    conduction, face = thermal.conduction, thermal.face
    assert isinstance(face, InterfaceHeat)
    problem = _conducting(system, heat, thermal)
    details = face_traces(problem.surplus, system.contacts)
    traces = [sp.vstack(both) for both in zip(face.traces, details, strict=True)]
    fluxes = zip(traces, temperatures.faces.flux, strict=True)
    loads = np.sum([trace @ (face.weights * flux) for trace, flux in fluxes], axis=0)
    nodal = loads[: conduction.spaces.owned]
    nodal += conduction.joint_heat(temperatures.rise, nodal)
    before = problem.field(temperatures.rise)
    change = problem.correction(problem.residual(before, loads))
    uncoupled = np.array([sum_over_ranks(system.comm, trace.T @ change) for trace in traces])
    # the nodal space cannot represent the response to a flux that levels finer details
    weighted = scaled(face.weights, face.basis)
    mass = dense(weighted.T @ face.basis)
    resolved = face.basis @ np.linalg.lstsq(mass, weighted.T @ uncoupled.T, rcond=None)[0]
    exchange = face.exchange(conductance)
    none = np.zeros(len(face.weights))
    coupled = exchange.state(none, BaselineResponse((resolved[:, 0], resolved[:, 1])))
    change[: conduction.spaces.owned] += conduction.respond(face.nodal_heat(coupled, bath=True))
    finer = _levelled(uncoupled - resolved.T, face, conductance)
    return TemperatureChange(np.array(coupled.rise) + finer, problem.functions(before + change))


def _levelled(rises: np.ndarray, face: InterfaceHeat, conductance: np.ndarray) -> np.ndarray:
    """Rises of both faces (2, n) below the nodal resolution after their exchange of heat [K].

    Approximation: each point has a resistance of its own in either body, its rise per own flux.
    """
    own = np.zeros_like(rises)
    for nodes, response in zip(face.nodes, face.response, strict=True):
        own += [values.multiply(values @ response).sum(axis=1) for values in nodes.values]
    own = np.abs(face.weights * own)
    with np.errstate(divide="ignore"):
        flux = (rises[1] - rises[0]) / (own.sum(axis=0) + 1 / conductance)
    return rises + own * flux * np.array([[1.0], [-1.0]])


def _conducting(system: System, heat: Heat, thermal: ThermalSystem) -> EnrichedProblem:
    """Conduction with its surplus space; corrections transfer heat to a bath at both faces."""
    conduction, model, bodies = thermal.conduction, system.model, system.bodies
    degree, kinematics = model.discretisation.degree, system.elastic.kinematics
    conductivities = {part: m.conductivity for part, m in conducting_parts(model).items()}
    surplus, given_h = surplus_spaces(bodies, degree), cooling(model, heat)
    terms = [
        [
            conducting(body, kinematics, conductivities, degree + 1),
            *transferring(body, kinematics, given_h),
        ]
        for body in bodies.each
    ]
    shifts = {
        name: float(shift[points.start])
        for interface, points in zip(model.interfaces, system.contacts.ranges, strict=True)
        for name, shift in zip(interface.faces, thermal.face.shifts, strict=True)
    }
    bath = [transferring(body, kinematics, shifts) for body in bodies.each]
    left_out = *heat.temperature, *conduction.joints.surfaces
    given, _ = given_rises(bodies, surplus, dict.fromkeys(left_out, 0.0), None)
    return EnrichedProblem(
        conduction.spaces, surplus, terms, conduction.respond, (conduction.fixed, given), bath
    )
