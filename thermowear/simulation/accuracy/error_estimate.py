"""Estimate of the discretisation error of a result from its change by the next degree.

* Pressure: mean of ``|p - p⁺|`` over the contact, relative to the mean of ``p``. It exists for any
  pressure, also for edge singularities, where no largest value converges. The change of the largest
  value is reported separately.
* Shape: largest change of the elastic opening in the contact area, up to a rigid motion of the
  holder, relative to the range of the shape.
* Temperature: largest change at the faces, relative to the largest rise there.

The next degree finds most of the error, higher degrees the rest: if each degree reduces the error
by a factor of three, the total is one and a half times the change.

Where wear continues up to an edge, as in growing contacts, the pressure ends with a jump, which the
contact points locate to half their distance. That is the least error of the pressure.

The geometric error of curved faces and the time discretisation error are not included.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...contact.operators.coupled_heat import CoupledHeat
from ...contact.search.pairing import pair
from ...contact.solvers.enriched_pressure import enriched_pressure
from ...errors import CaseError, ComputationError
from ...model.analyses import Analysis
from ...results import InterfaceFields
from ..interface.equilibrium import ContactState
from ..interface.steady import principle
from ..results.recording import Snapshot
from ..system.building import sliding_contact
from ..system.conditions import InterfaceConditions
from ..system.system import System
from .enriched_bodies import EnrichedBodies, TemperatureChange, temperature_change

_FOLLOWING = 1.5
"""Ratio of the change by all higher degrees to that by the next one: 1 + 1/3 + 1/9 …"""
WORTH_A_WARNING = 0.05
_PART = 0.2
"""Part of the available memory that the estimate may take in space."""
_FLAT = 1e-9
"""Range of a shape at rounding level, relative to the elastic deflection."""


_NAMES = {"max_pressure": "largest pressure"}


@dataclass(frozen=True)
class ErrorEstimates:
    """Estimates of the relative errors, see the module; None where there is no estimate.

    Attributes
    ----------
    errors : dict of str to (float or None)
        Errors of pressure, max_pressure, shape and temperature.
    missing : dict of str to str
        Reason for a missing estimate, by quantity.
    """

    errors: dict[str, float | None]
    missing: dict[str, str]

    def summary(self) -> dict:
        """Keys of ``summary.json``."""
        found = {f"{q}_error_estimate_relative": error for q, error in self.errors.items()}
        return found | {"error_estimate_missing": self.missing}

    def warning(self) -> str | None:
        """Warning that lists the errors above `WORTH_A_WARNING`; None without any."""
        above = {q: e for q, e in self.errors.items() if e and e > WORTH_A_WARNING}
        if not above:
            return None
        large = ", ".join(f"{_NAMES.get(q, q)} {100 * e:.2g} %" for q, e in above.items())
        return (
            f"estimated discretisation error above 5 %: {large}; use more mesh.elements, "
            "for CAD parts a smaller mesh.contact_size, or a higher mesh.degree, and compare by "
            "`run --accuracy`"
        )


def estimate_errors(analysis: Analysis, end: Snapshot) -> ErrorEstimates:
    """Estimate the errors at the end of an analysis. Every rank calls."""
    system, steady = end.system, analysis.type == "steady"
    missing: dict[str, str] = {}
    errors: dict[str, float | None] = dict.fromkeys(
        ("pressure", "max_pressure", "shape", "temperature")
    )
    heated, why = _temperature_change(end)
    if heated is not None:
        errors["temperature"] = _of_temperature(end, heated)
    if errors["temperature"] is None:
        missing["temperature"] = why or "no temperature differs from the ambient one"
    bodies = EnrichedBodies(system)
    opened = bodies.opening(end.contact, end.bodies, heated)
    if system.thermal is not None and heated is None:
        missing["shape"] = f"temperature: {why}"
    else:
        errors["shape"] = _of_shape(end, opened, steady)
        if errors["shape"] is None:
            missing["shape"] = "the faces have no shape by wear"
    if not end.interface.pressure.any():
        missing["pressure"] = "nothing presses"
        return ErrorEstimates(errors, missing)
    if not steady and _enriched_memory(system) > _PART * system.choice.available:
        missing["pressure"] = "not estimated for this many contact points"
        return ErrorEstimates(errors, missing)
    try:
        if steady:
            enriched = _finer_principle(system, end.contact)
        else:
            enriched = _enriched_pressure(end, bodies, opened)
        mean, largest = _of_pressure(system, end.interface.pressure, enriched)
        errors["pressure"] = max(mean, _of_edges(system, end.interface))
        errors["max_pressure"] = largest
    except (CaseError, ComputationError, np.linalg.LinAlgError) as error:
        missing["pressure"] = str(error)
    return ErrorEstimates(errors, missing)


def _enriched_memory(system: System) -> float:
    """Memory of `enriched_pressure`, whose finer space has four times the functions [bytes]."""
    points, functions = system.basis.shape
    return 8.0 * points * functions * (2 + 3 * 4)


def _temperature_change(end: Snapshot) -> tuple[TemperatureChange | None, str | None]:
    """Change of the temperatures by the next degree, or the reason why there is no estimate."""
    thermal, heat = end.system.thermal, end.system.model.heat
    found = end.bodies.temperatures
    if thermal is None or heat is None or found is None:
        return None, "isothermal"
    if heat.transient:
        return None, "not estimated where temperatures are followed in time"
    if heat.flux or heat.power:
        return None, "not estimated where heat is given on surfaces"
    if thermal.varies:
        return None, "not estimated where conductivity or expansion change with temperature"
    if heat.advection != "none":
        return None, "not estimated where a body carries heat along"
    if isinstance(thermal.face, CoupledHeat):
        return None, "not estimated for this many contact points"
    conductance = end.contact.conditions.conductance
    return temperature_change(end.system, heat, thermal, found, conductance), None


def _of_temperature(end: Snapshot, heated: TemperatureChange) -> float | None:
    assert end.bodies.temperatures is not None
    largest = float(np.abs(end.bodies.temperatures.faces.rise).max())
    return _FOLLOWING * float(np.abs(heated.faces).max()) / largest if largest > 0 else None


def _of_shape(end: Snapshot, opened: np.ndarray, steady: bool) -> float | None:
    system, interface = end.system, end.interface
    worn = np.any([interface.wear_1, interface.wear_2]) or steady
    pressing = interface.pressure > 0
    flat = _FLAT * np.abs(end.bodies.opening).max(initial=0.0)
    shaped = [points for points in system.contacts.ranges if np.ptp(interface.shape[points]) > flat]
    if not worn or not shaped or not pressing.any():
        return None
    modes, change = system.holder.modes[pressing], opened[pressing]
    roots = np.sqrt(system.weights[pressing])
    motion = np.linalg.lstsq(modes * roots[:, None], change * roots, rcond=None)[0]
    left = np.zeros(len(opened))
    left[pressing] = np.abs(change - modes @ motion)
    own = [left[points].max() / np.ptp(interface.shape[points]) for points in shaped]
    return _FOLLOWING * float(max(own))


def _of_edges(system: System, interface: InterfaceFields) -> float:
    """Mean error of a worn pressure by the position of its ends: half a contact point at each edge.

    Enrichment does not detect that error, as the worn gap is the same.
    """
    weights, facet = system.weights, system.contacts.facet
    if system.contacts.in_space or not np.any([interface.wear_1, interface.wear_2]):
        return 0.0
    pressure = interface.pressure
    last = np.zeros(len(pressure), dtype=bool)
    for own in system.contacts.ranges:
        pressing = np.pad(pressure[own] > 0.0, 1, mode="edge")
        last[own] = pressing[1:-1] & ~(pressing[:-2] & pressing[2:])
    largest = np.zeros(facet.max() + 1)
    np.maximum.at(largest, facet, weights)
    return float(pressure[last] @ largest[facet[last]] / 2 / (weights @ pressure))


def _of_pressure(system: System, pressure: np.ndarray, enriched: np.ndarray) -> tuple[float, float]:
    total, largest = float(system.weights @ pressure), float(pressure.max())
    change = float(system.weights @ np.abs(enriched - pressure))
    peak = abs(float(enriched.max()) - largest)
    return _FOLLOWING * change / total, _FOLLOWING * peak / largest


def _enriched_pressure(end: Snapshot, bodies: EnrichedBodies, opened: np.ndarray) -> np.ndarray:
    """Pressure of an enriched discretisation at the contact points, shape (n,) [Pa]."""
    system, interface = end.system, end.interface
    model = system.model
    if any(one.pressure_degree == "lobatto" for one in model.interfaces):
        raise ComputationError('not estimated for contact.pressure_degree = "lobatto"')
    return enriched_pressure(
        system.contacts,
        system.influence,
        [model.pressure_degree(one) + 1 for one in model.interfaces],
        system.holder,
        interface.pressure,
        interface.gap + opened,
        system.softness + _wear_per_pressure(system, interface),
        bodies.answer,
    )


def _wear_per_pressure(system: System, interface: InterfaceFields) -> np.ndarray:
    """Least wear depth on the facet of each point per mean pressure, shape (n,) [m/Pa].

    Wear acts as a local compliance against a persistent error of the pressure: the gap component
    orthogonal to the pressure space results from the wear by that error over the whole run. Where
    a part of the facet is unworn, the wear depth at the point itself is used.
    """
    pressing = interface.pressure > 0
    mean = np.average(interface.pressure[pressing], weights=system.weights[pressing])
    facet = system.contacts.facet
    least = np.full(facet.max() + 1, np.inf)
    depth = interface.wear_1 + interface.wear_2
    np.minimum.at(least, facet, depth)
    return np.where(least[facet] > 0.0, least[facet], np.maximum(depth, 0.0)) / mean


def _finer_principle(system: System, contact: ContactState) -> np.ndarray:
    """Steady pressure by a finer quadrature, the only discretisation error of the principle."""
    if system.worn is not None:
        raise ComputationError("not estimated on moved meshes")
    if any("T" in law.variables for law in system.laws.values()):
        raise ComputationError("not estimated where wear depends on the temperature")
    coarse, fine = (
        principle(each, contact.conditions.load, speed=each.speed, friction=each.friction)
        for each in (system, _finer(system))
    )
    velocity = system.holder.modes @ coarse.velocity
    change = system.holder.modes @ fine.velocity - velocity
    pressure = contact.pressure
    exponent = _exponent(system, pressure, contact.conditions)
    moving = np.where(pressure > 0, velocity, 1.0)
    return pressure * (1 + change / (exponent * moving))


def _exponent(system: System, pressure: np.ndarray, conditions: InterfaceConditions) -> float:
    """Least exponent of the pressure in the wear rates in contact, ``p h'(p)/h(p)``."""
    pressing, least = pressure > 0, np.inf
    for row, law in enumerate(system.laws.values()):
        rate = conditions.wear_rate(row, law, pressure)
        slope = conditions.wear_slope(row, law, pressure)
        wears = pressing & (rate > 0)
        least = min(least, float((pressure * slope / np.where(wears, rate, 1.0))[wears].min()))
    return least


def _finer(system: System) -> System:
    """System with more contact points, for the steady-state principle only."""
    model, kinematics = system.model, system.elastic.kinematics
    finer = []
    for interface, coarse in zip(model.interfaces, system.contacts.each, strict=True):
        face_1, face_2 = (side.face for side in coarse.sides)
        lobatto = interface.pressure_degree == "lobatto"
        order = model.discretisation.degree + (2 if lobatto else 3)
        given = face_1, face_2, kinematics, order
        finer.append(pair(*given, refine=not lobatto, carrier=coarse.carrier))
    driven = system.holder.rigid_modes
    contacts = replace(system.contacts, each=tuple(finer))
    contact = sliding_contact(model, kinematics, contacts, driven)
    return replace(system, contacts=contacts, **contact)
