"""Fitting of element ends to the contact edges (``contact.positioning``)."""

from __future__ import annotations

import numpy as np

from ...contact.operators.pressure import contact_zones
from ...errors import ComputationError
from ...model.model import Model
from ...timer import Phases
from ..interface.interface_problem import interface_problem
from ..system.building import build
from ..system.setup_cache import SetupCache
from ..system.system import System

_ITERATIONS = 12
_TOLERANCE = 0.1  # relative to the element at the edge
_LARGEST_SLOPE = 4.0
_LONGEST = 0.4  # relative to the zone, so that its edges cannot swap


def prepare(
    model: Model, comm, phases: Phases, parts: SetupCache | None = None, single: bool = False
) -> System:
    """Build the system of a model, fitted to the contact edges if requested. Every rank calls.

    A set-up cache is not used for a mesh that depends on the contact of the model. `single` is as
    in `build`.

    Raises
    ------
    CaseError, ComputationError
        If it cannot be meshed, or the contact edges do not converge.
    """
    if not model.discretisation.positioning:
        return build(model, comm, phases, parts=parts, single=single)
    expected = model.expected_zone
    zone = np.array(touching(build(model, comm, phases)) if expected is None else expected)
    before: tuple[np.ndarray, np.ndarray] | None = None
    for _ in range(_ITERATIONS):
        system = build(model, comm, phases, (float(zone[0]), float(zone[1])))
        with phases("contact"):
            residual = np.array(touching(system)) - zone
        # half models have no left edge
        off = np.abs(residual[1:] if model.symmetry else residual).max()
        if off < _TOLERANCE * _smallest(system):
            return system
        zone, before = zone + _step(zone, residual, before), (zone, residual)
    raise ComputationError(
        f"contact.positioning: the edges of the contact did not settle in {_ITERATIONS} meshes; "
        "use more elements (mesh.elements), or contact.positioning = false"
    )


def touching(system: System) -> tuple[float, float]:
    """Range of x in which the unworn faces touch [m].

    Raises
    ------
    ComputationError
        If the faces touch in several places, or nowhere.
    """
    contact = interface_problem(system).unworn().contact
    zones = contact_zones(system.pairing, contact.pressure)
    if len(zones) != 1:
        raise ComputationError(
            f"contact.positioning: the faces touch in {len(zones)} places; "
            "positioning is for one contact zone"
        )
    first, last = system.pairing.locate(list(zones[0]))[:, 0]
    return float(first), float(last)


def _step(zone: np.ndarray, residual: np.ndarray, before) -> np.ndarray:
    """Displacement of each zone edge, by a secant step after the first one.

    The position of a contact edge depends slightly on the mesh.
    """
    if before is None:
        return residual
    moved, changed = zone - before[0], residual - before[1]
    slope = np.divide(changed, moved, out=np.full(2, -1.0), where=moved != 0.0)
    longest = _LONGEST * (zone[1] - zone[0])
    return np.clip(
        residual / -np.clip(slope, -_LARGEST_SLOPE, -1 / _LARGEST_SLOPE), -longest, longest
    )


def _smallest(system: System) -> float:
    """Size of the smallest element of the contact face [m]."""
    nodes = system.pairing.carrying.face.nodes
    return float(np.linalg.norm(nodes[:, -1] - nodes[:, 0], axis=1).min())
