"""Estimate of the discretisation error of a result from its change by the next degree.

* Pressure: mean of ``|p - p⁺|`` over the contact, relative to the mean of ``p``. It exists for any
  pressure, also for edge singularities, where no largest value converges. The change of the largest
  value is reported separately.
* Shape: largest change in the contact area, up to a rigid motion of the holder, relative to the
  range of the shape: in a steady state of the elastic opening, in time of the wear by the change of
  the pressure.
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

from ...contact.search.pairing import PairedFace, pair
from ...contact.solvers.enriched_pressure import EnrichedContact
from ...errors import CaseError, ComputationError, percent
from ...lagrange import lattice
from ...model.analyses import Analysis
from ...results import InterfaceFields
from ..interface.steady import principle
from ..results.recording import Snapshot
from ..system.building import sliding_contact
from ..system.conditions import InterfaceConditions
from ..system.system import System
from .enriched_bodies import (
    EnrichedBodies,
    TemperatureChange,
    heated_faces,
    temperature_change,
)

_FOLLOWING = 1.5
"""Ratio of the change by all higher degrees to that by the next one: 1 + 1/3 + 1/9 …"""
WORTH_A_WARNING = 0.05
_MANY = 10_000_000
"""Product of the numbers of points and functions from which the enriched contact is linearised."""
_HIGH = 0.7
"""Part of the largest pressure above which pressures are large."""
_LEAST = 0.2
"""Least error of the largest pressure, relative to the mean error."""
_FLAT = 1e-9
"""Range of a shape at rounding level, relative to the elastic deflection."""


_FLAT_COSINE, _EDGE_COSINE = np.cos(np.radians([0.1, 20.0]))
"""Cosine between the normals of a facet and of a face, of flat facets and at an edge."""
_NAMES = {
    "max_pressure": "largest pressure",
    "max_pressure_of_cycle": "the largest pressure of the cycle",
}
_ISOTHERMAL = "isothermal"
_AMBIENT = "no temperature differs from the ambient one"
_OPEN = "nothing presses"
_UNWORN = "the faces have no shape by wear"
_SINGULAR = "it is at a sharp edge, where it has no limit"
_NOTHING_TO_ESTIMATE = {_ISOTHERMAL, _AMBIENT, _OPEN, _UNWORN, _SINGULAR}


@dataclass(frozen=True)
class ErrorEstimates:
    """Estimates of the relative errors, see the module; None where there is no estimate.

    Attributes
    ----------
    errors : dict of str to (float or None)
        Errors of pressure, max_pressure, shape and temperature.
    missing : dict of str to str
        Reason for a missing estimate, by quantity.
    flat_facets : bool
        Whether flat facets stand for a curved face, whose error the estimate does not include.
    """

    errors: dict[str, float | None]
    missing: dict[str, str]
    flat_facets: bool = False

    def summary(self) -> dict:
        """Keys of ``summary.json``."""
        found = {f"{q}_error_estimate_relative": error for q, error in self.errors.items()}
        return found | {"error_estimate_missing": self.missing}

    def notes(self) -> list[str]:
        """Notes on errors above `WORTH_A_WARNING`, and on those that are not estimated."""
        notes = []
        above = {q: e for q, e in self.errors.items() if e and e > WORTH_A_WARNING}
        if above:
            large = ", ".join(f"{_NAMES.get(q, q)} {percent(e)}" for q, e in above.items())
            advice = (
                "flat facets stand for a curved contact face, and the pressures of their edges do "
                "not converge with mesh.degree; curve them by geometry.curved, or by cells of "
                "order 2"
                if self.flat_facets
                else "use more mesh.elements, for CAD parts a smaller mesh.contact_size, or a "
                "higher mesh.degree, and compare by `run --accuracy`"
            )
            notes.append(f"estimated discretisation error above 5 %: {large}; {advice}")
        reasons = {q: why for q, why in self.missing.items() if why not in _NOTHING_TO_ESTIMATE}
        for reason in dict.fromkeys(reasons.values()):
            quantities = " and ".join(
                _NAMES.get(q, q) for q, why in reasons.items() if why == reason
            )
            notes.append(
                f"no estimate of the discretisation error of {quantities}, because {reason}; "
                "compare by `run --accuracy`"
            )
        return notes


def estimate_errors(analysis: Analysis, end: Snapshot, time: float) -> ErrorEstimates:
    """Estimate the errors at the end of an analysis, at a time [s]. Every rank calls."""
    system, steady = end.system, analysis.type == "steady"
    missing: dict[str, str] = {}
    errors: dict[str, float | None] = dict.fromkeys(
        ("pressure", "max_pressure", "shape", "temperature")
    )
    if analysis.type == "reciprocating":
        missing["max_pressure_of_cycle"] = "all estimates are those of mid-stroke"
    heated, why = _temperature_change(end, time)
    if heated is not None:
        errors["temperature"] = _of_temperature(end, heated, end.interface.pressure)
    if errors["temperature"] is None:
        missing["temperature"] = why or _AMBIENT
    bodies = EnrichedBodies(system)
    opened = bodies.opening(end.contact, end.bodies, heated)
    flat = any(_flat_facets(side) for one in system.contacts.each for side in one.sides)
    if not end.interface.pressure.any():
        missing["pressure"] = missing["shape"] = _OPEN
        return ErrorEstimates(errors, missing, flat)
    change = opened if steady else None
    try:
        if steady:
            enriched = _coarser_principle(end)
        else:
            enriched = _enriched_pressure(end, bodies, opened)
            change = _wear_change(end, enriched)
            if heated is not None:
                errors["temperature"] = _of_temperature(end, heated, enriched)
        errors["pressure"], errors["max_pressure"] = _of_pressure(end, enriched)
        if not steady and _singular(end):
            errors["max_pressure"], missing["max_pressure"] = None, _SINGULAR
    except (CaseError, ComputationError, np.linalg.LinAlgError) as error:
        missing["pressure"] = str(error)
    shaped = _shaped(end, steady)
    if not shaped:
        missing["shape"] = _UNWORN
    elif system.thermal is not None and heated is None:
        missing["shape"] = str(why)
    elif change is None:
        missing["shape"] = missing["pressure"]
    else:
        errors["shape"] = _of_shape(end, change, shaped, ~(steady & system.at_rest))
    return ErrorEstimates(errors, missing, flat)


def _flat_facets(side: PairedFace) -> bool:
    """Whether adjacent facets of order 1 are turned against each other, but not as at an edge."""
    face = side.face
    if face.order > 1:
        return False
    normals = face.normals(*face.on_each(lattice(1, face.kind).reshape(-1, face.dim)))
    corners = face.corner_numbers.ravel()
    mean = np.zeros((corners.max() + 1, normals.shape[1]))
    np.add.at(mean, corners, normals)
    cosines = np.sum(normals * mean[corners], axis=1) / np.linalg.norm(mean, axis=1)[corners]
    return bool(np.any((cosines < _FLAT_COSINE) & (cosines > _EDGE_COSINE)))


def _singular(end: Snapshot) -> bool:
    """Test whether the largest pressure is at a sharp edge that is not worn. Every rank calls."""
    fields, largest = end.interface, int(end.interface.pressure.argmax())
    worn = fields.wear_1[largest] + fields.wear_2[largest] > 0.0
    return bool(end.system.at_singular_edges[largest]) and not worn


def _wear_change(end: Snapshot, enriched: np.ndarray) -> np.ndarray:
    """Change of the wear depth by that of the pressure during the whole wear, (n,) [m].

    Wear levels the change of the elastic gap where it is large, see `_wear_per_pressure`.
    """
    return _wear_per_pressure(end.system, end.interface) * (enriched - end.interface.pressure)


def _temperature_change(end: Snapshot, time: float) -> tuple[TemperatureChange | None, str | None]:
    """Change of the temperatures by the next degree, or the reason why there is no estimate."""
    thermal, heat = end.system.thermal, end.system.model.heat
    found = end.bodies.temperatures
    if thermal is None or heat is None or found is None:
        return None, _ISOTHERMAL
    if heat.transient and thermal.conduction.joints.count:
        return None, "temperatures of glued bodies are followed in time"
    if thermal.varies:
        return None, "conductivity or expansion change with temperature"
    conductance = end.contact.conditions.conductance
    return temperature_change(end.system, heat, thermal, found, conductance, time), None


def _of_temperature(end: Snapshot, heated: TemperatureChange, enriched: np.ndarray) -> float | None:
    """Error of the temperature by its change and that of the pressure, which makes the heat."""
    system, found, conditions = end.system, end.bodies.temperatures, end.contact.conditions
    assert found is not None
    assert system.thermal is not None
    largest = float(np.abs(found.faces.rise).max())
    if largest == 0.0:
        return None
    more = conditions.heating * (enriched - end.interface.pressure)
    faces = heated.faces
    if more.any():
        faces = faces + heated_faces(system, system.thermal, more, conditions.conductance)
    return _FOLLOWING * float(np.abs(faces).max()) / largest


def _shaped(end: Snapshot, steady: bool) -> list[slice]:
    """Ranges of the points of interfaces that are in contact with a shape by wear."""
    system, interface = end.system, end.interface
    if not (steady or np.any([interface.wear_1, interface.wear_2])):
        return []
    flat = _FLAT * np.abs(end.bodies.opening).max(initial=0.0)
    return [points for points in system.contacts.ranges if np.ptp(interface.shape[points]) > flat]


def _of_shape(end: Snapshot, change: np.ndarray, shaped: list[slice], worn: np.ndarray) -> float:
    """Error of the shape from its change where worn (n,) points press, up to holders' motions."""
    system, interface = end.system, end.interface
    pressing = (interface.pressure > 0) & worn
    modes, own = system.holder.modes[pressing], change[pressing]
    roots = np.sqrt(system.weights[pressing])
    motion = np.linalg.lstsq(modes * roots[:, None], own * roots, rcond=None)[0]
    left = np.zeros(len(change))
    left[pressing] = np.abs(own - modes @ motion)
    each = [left[points].max() / np.ptp(interface.shape[points]) for points in shaped]
    return _FOLLOWING * float(max(each))


def _worn_ends(system: System, interface: InterfaceFields) -> np.ndarray:
    """Last points that press at the ends of worn contacts of a section, within the faces, (n,)."""
    last = np.zeros(len(interface.pressure), dtype=bool)
    if system.contacts.in_space or not np.any([interface.wear_1, interface.wear_2]):
        return last
    for own in system.contacts.ranges:
        pressing = np.pad(interface.pressure[own] > 0.0, 1, mode="edge")
        last[own] = pressing[1:-1] & ~(pressing[:-2] & pressing[2:])
    return last


def _of_edges(system: System, pressure: np.ndarray, last: np.ndarray) -> float:
    """Mean error of a worn pressure by the position of its ends: half a contact point at each edge.

    Enrichment does not detect that error, as the worn gap is the same.
    """
    largest = _over_facets(np.maximum, system, system.weights)
    return float(pressure[last] @ largest[last] / 2 / (system.weights @ pressure))


def _over_facets(extreme: np.ufunc, system: System, values: np.ndarray) -> np.ndarray:
    """Extreme of values (n,) over all points of the facets of each point, shape (n,)."""
    facets, result = system.contacts.facets, values.copy()
    facet, point = facets.nonzero()
    of_facets = np.zeros(facets.shape[0])
    of_facets[facet] = values[point]  # any value of each
    extreme.at(of_facets, facet, values[point])
    extreme.at(result, point, of_facets[facet])
    return result


def _of_pressure(end: Snapshot, enriched: np.ndarray) -> tuple[float, float]:
    """Errors of the pressure in the mean, and of its largest value.

    The largest value may agree by chance: the change of all large pressures counts, too, by the
    geometric mean of both, and at least a part of the mean error. Elements that the end of a worn
    contact cuts have conditions at their points, which enriched ones do not have: they count in
    the mean alone, and the position of the ends in all pressures.
    """
    system, pressure = end.system, end.interface.pressure
    last, facets = _worn_ends(system, end.interface), system.contacts.facets
    change = np.abs(enriched - pressure)
    mean = _FOLLOWING * float(system.weights @ change / (system.weights @ pressure))
    ends = _of_edges(system, pressure, last)
    mean = max(mean, ends)
    whole = ~((facets @ last) @ facets)
    whole |= not pressure[whole].any()
    pressure, enriched, change = pressure[whole], enriched[whole], change[whole]
    largest, other = float(pressure.max()), float(enriched.max())
    high = float(change[np.maximum(pressure, enriched) > _HIGH * max(largest, other)].max())
    peak = np.sqrt(abs(other - largest) * high)
    return mean, max(_LEAST * mean, ends, _FOLLOWING * float(peak) / largest)


def _enriched_pressure(end: Snapshot, bodies: EnrichedBodies, opened: np.ndarray) -> np.ndarray:
    """Pressure of an enriched discretisation at the contact points, shape (n,) [Pa]."""
    system, interface = end.system, end.interface
    model = system.model
    if any(one.pressure_degree == "lobatto" for one in model.interfaces):
        raise ComputationError('contact.pressure_degree = "lobatto" has no richer pressures')
    contact = EnrichedContact(
        system.contacts,
        system.influence,
        [model.pressure_degree(one) + 1 for one in model.interfaces],
        system.holder,
        interface.pressure,
        interface.gap + opened,
        system.softness + _wear_per_pressure(system, interface),
        bodies.answer,
    )
    many = np.prod(system.basis.shape) > _MANY
    return contact.linearised() if many else contact.solved()


def _wear_per_pressure(system: System, interface: InterfaceFields) -> np.ndarray:
    """Least wear depth on the facet of each point per mean pressure, shape (n,) [m/Pa].

    Wear acts as a local compliance against a persistent error of the pressure: the gap component
    orthogonal to the pressure space results from the wear by that error over the whole run. Where
    a part of the facet is unworn, the wear depth at the point itself is used.
    """
    pressing = interface.pressure > 0
    mean = np.average(interface.pressure[pressing], weights=system.weights[pressing])
    depth = interface.wear_1 + interface.wear_2
    least = _over_facets(np.minimum, system, depth)
    return np.where(least > 0.0, least, np.maximum(depth, 0.0)) / mean


def _coarser_principle(end: Snapshot) -> np.ndarray:
    """Steady pressure by a coarser quadrature, the only discretisation error of the principle."""
    system, contact = end.system, end.contact
    if system.at_rest.any():
        raise ComputationError("contacts at rest keep their elastic pressure")
    if system.worn is not None:
        raise ComputationError("the meshes were moved to the worn faces")
    if any("T" in law.variables for law in system.laws.values()):
        raise ComputationError("wear depends on the temperature")
    conditions = contact.conditions

    def velocity(each: System) -> np.ndarray:
        found = principle(each, conditions.load, speed=each.speed, friction=each.friction)
        return system.holder.modes @ found.velocity

    nominal = (
        np.array_equal(conditions.friction, system.friction)
        and np.array_equal(conditions.speed, system.speed)
        and bool(np.all(conditions.wear == 1.0))
    )
    known = end.wear_velocity if nominal else None
    own = velocity(system) if known is None else system.holder.modes @ known
    pressure = contact.pressure
    exponent = _exponent(system, pressure, conditions)
    moving = np.where(pressure > 0, own, 1.0)
    return pressure * (1 + (velocity(_coarser(system)) - own) / (exponent * moving))


def _exponent(system: System, pressure: np.ndarray, conditions: InterfaceConditions) -> float:
    """Least exponent of the pressure in the wear rates in contact, ``p h'(p)/h(p)``."""
    pressing, least = pressure > 0, np.inf
    for row, law in enumerate(system.laws.values()):
        rate = conditions.wear_rate(row, law, pressure)
        slope = conditions.wear_slope(row, law, pressure)
        wears = pressing & (rate > 0)
        least = min(least, float((pressure * slope / np.where(wears, rate, 1.0))[wears].min()))
    return least


def _coarser(system: System) -> System:
    """System with fewer contact points, for the steady-state principle only."""
    model, kinematics = system.model, system.elastic.kinematics
    coarser = []
    for interface, fine in zip(model.interfaces, system.contacts.each, strict=True):
        face_1, face_2 = (side.face for side in fine.sides)
        lobatto = interface.pressure_degree == "lobatto"
        order = model.discretisation.degree + (0 if lobatto else 1)
        given = face_1, face_2, kinematics, max(order, 2)
        coarser.append(pair(*given, not lobatto, comm=system.comm, carrier=fine.carrier))
    driven = system.holder.rigid_modes
    contacts = replace(system.contacts, each=tuple(coarser))
    contact = sliding_contact(model, kinematics, contacts, driven)
    return replace(system, contacts=contacts, **contact)
