"""From a case to a system and its interface problem: the choices that the case makes."""

from __future__ import annotations

import numpy as np

from ..case.schema import Case
from ..contact.zones import contact_zones
from ..errors import ComputationError
from .condensed_method import CondensedMethod
from .friction_heat import FrictionHeat
from .full_method import FullMethod
from .interface_problem import InterfaceProblem
from .phases import Phases
from .system import System, build

_PASSES = 12
_SETTLED = 0.1  # of the element at the edge


def interface_problem(system: System) -> InterfaceProblem:
    """The interface of a system, solved by the method of the case. Every rank calls."""
    heat = None if system.thermal is None else FrictionHeat(system, system.thermal)
    if system.case.contact.method == "condensed":
        return InterfaceProblem(system, CondensedMethod(system, heat), heat)
    with system.phases("contact operators"):
        method = FullMethod(system, heat)
    return InterfaceProblem(system, method, heat)


def prepare(case: Case, comm, phases: Phases) -> System:
    """Build the system of a case, positioned where the case asks for it. Every rank calls.

    Raises
    ------
    CaseError, ComputationError
        If it cannot be meshed, or the edges of the contact do not settle.
    """
    if not case.contact.positioning:
        return build(case, comm, phases)
    zone = case.geometry.expected_zone(case.pressing())
    if zone is None:
        zone = touching(build(case, comm, phases))
    for step in range(_PASSES):
        system = build(case, comm, phases, zone)
        with phases("contact"):
            found = touching(system)
        if _distance(found, zone, case.geometry.symmetry) < _SETTLED * _smallest(system):
            return system
        # what is found varies a little with the mesh: later meshes count less
        share = 1 / max(step, 1)
        zone = (zone[0] + share * (found[0] - zone[0]), zone[1] + share * (found[1] - zone[1]))
    raise ComputationError(
        f"contact.positioning: the edges of the contact did not settle in {_PASSES} meshes; "
        "use more elements (mesh.elements), or contact.positioning = false"
    )


def touching(system: System) -> tuple[float, float]:
    """Range of x in which the unworn faces touch [m].

    Raises
    ------
    ComputationError
        If the faces touch in several places, or nowhere.
    """
    contact = interface_problem(system).unworn()
    zones = contact_zones(system.pairing, contact.pressure)
    if len(zones) != 1:
        raise ComputationError(
            f"contact.positioning: the faces touch in {len(zones)} places; "
            "positioning is for one contact zone"
        )
    first, last = system.pairing.locate(list(zones[0]))[:, 0]
    return float(first), float(last)


def _distance(found: tuple[float, float], zone: tuple[float, float], symmetry) -> float:
    """How far the edges are from where the mesh has them; half models have the right one only."""
    moved = [abs(a - b) for a, b in zip(found, zone, strict=True)]
    return moved[1] if symmetry else max(moved)


def _smallest(system: System) -> float:
    """Size of the smallest element of the contact face [m]."""
    nodes = system.pairing.sides[0].face.nodes
    return float(np.linalg.norm(nodes[:, -1] - nodes[:, 0], axis=1).min())
