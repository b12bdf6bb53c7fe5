"""Wider zones: whether the contact fits the meshed one, remeshing, counts over all meshes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import add
from typing import Any

import numpy as np
import scipy

from ...errors import CaseError
from ...laws.distribution import InPlace
from ...model.model import Zone
from ...serialise import serialisable
from ..interface.interface_problem import InterfaceProblem, interface_problem
from ..interface.sdirk import InterfaceState
from ..points.worn_geometry import WornGeometry
from ..system.building import build
from ..system.system import System

_WIDER = 1.6
"""Width of the next zone relative to the contact, at the same number of elements."""
_RIM = 0.97
"""Distance of the rim of a round face in space from its middle, relative to its radius."""
_ROUNDING = 1e-9
"""Tolerance of positions, relative to the length of the face."""
_COMBINED: dict[str, Callable[[Any, Any], Any]] = {
    "updates": add,
    "meshed_anew": add,
    "quality": min,
}
"""Combination of the counters of successive meshes, by default the largest."""


def ends_outside_zone(system: System) -> tuple[bool, bool]:
    """Test whether the first and the last end of the face lie outside the expected zone."""
    zone, x = system.model.expected_zone, system.contacts.points[:, 0]
    if zone is None:
        return False, False
    margin = 1e-6 * (zone[1] - zone[0])
    return bool(x.min() < zone[0] - margin), bool(x.max() > zone[1] + margin)


def _is_surface(system: System) -> bool:
    return system.contacts.in_space


def reaches_open_end(system: System, pressure: np.ndarray) -> bool:
    """True if the contact reaches an end of the face that lies outside the expected zone."""
    zone = system.model.expected_zone
    if zone is not None and _is_surface(system):
        middle = (zone[0] + zone[1]) / 2, 0.0
        away = np.linalg.norm(system.contacts.points[:, :2] - middle, axis=1)
        return bool(np.any(pressure[away > _RIM * away.max()] > 0))
    x = system.contacts.points[:, 0]
    ends = zip(ends_outside_zone(system), (x.argmin(), x.argmax()), strict=True)
    return any(outside and pressure[end] > 0 for outside, end in ends)


def wider_zone(system: System, pressure: np.ndarray) -> Zone | None:
    """New zone if the contact has come half way from its zone to an end of the face.

    None if it has not, or if the mesh has no zone.
    """
    zone, pairing = system.zone, system.pairing
    if zone is None or _is_surface(system) or not np.any(pressure > 0):
        return None
    x = pairing.points[:, 0]
    middle = 0.0 if system.model.symmetry else (zone[0] + zone[1]) / 2
    pressing = x[pressure > 0]
    found, wide = list(zone), False
    edges, ends = ((at.min(), at.max()) for at in (pressing, x))
    each = zip(ends_outside_zone(system), edges, ends, strict=True)
    for side, (open_ended, edge, end) in enumerate(each):
        if open_ended and abs(edge - zone[side]) >= abs(end - zone[side]) / 2 > 0.0:
            wide |= abs(edge - middle) > abs(zone[side] - middle)
            found[side] = middle + _WIDER * (edge - middle)
    if system.model.symmetry:
        found[0] = -found[1]
    return (float(found[0]), float(found[1])) if wide else None


def meshed_wider(
    problem: InterfaceProblem, state: InterfaceState, time: float, zone: Zone
) -> tuple[InterfaceProblem, InterfaceState] | str:
    """Continue on an unworn mesh for a wider zone, all wear in the gap. Every rank calls.

    Returns
    -------
    problem, state
        Or the reason (str) for which there are none.
    """
    if state.stored is not None:
        return "temperatures that are followed in time are not carried over to a wider zone"
    system = problem.system
    try:
        following = build(system.model, system.comm, system.phases, zone)
    except CaseError as reason:
        return str(reason)
    after = interface_problem(following)
    rows = _carried(system, following, state.worn)
    with system.phases("contact"):
        return after, after.take_over(problem, state, rows, None, time)


def _carried(before: System, after: System, worn: np.ndarray) -> np.ndarray:
    """Volume-preserving transfer of depths (n_wearing, n) to another mesh of the faces [m].

    Local wear is zero beyond the former face.
    """
    x, first = np.unique(before.pairing.points[:, 0], return_index=True)
    to = after.pairing.points[:, 0]
    rounding = _ROUNDING * (x[-1] - x[0])  # ends of moved and new meshes differ by rounding
    inside = (to >= x[0] - rounding) & (to <= x[-1] + rounding)
    curves = scipy.interpolate.Akima1DInterpolator(x, worn[:, first], axis=-1, method="makima")
    rows = np.maximum(curves(np.clip(to, x[0], x[-1])), 0.0)
    for row, depth, spread in zip(rows, worn, before.spreads.values(), strict=True):
        if isinstance(spread, InPlace):
            row[~inside] = 0.0
            had, has = depth @ before.weights, row @ after.weights
            row *= had / has if has > 0.0 else 1.0
    return rows


@serialisable
@dataclass(frozen=True)
class UpdateCounts:
    """Number of updates, and their worst errors and cell quality; see `WornGeometry`.

    A mesh for a wider zone starts with no updates; the counts of previous meshes are kept here.
    """

    updates: int = 0
    quality: float = float("inf")
    volume_error: float = 0.0
    change: float = 0.0
    heat_error: float = 0.0
    meshed_anew: int = 0
    carrying_error: float = 0.0

    def counting(self, worn: WornGeometry | None) -> UpdateCounts:
        """Counters including the updates of a mesh."""
        if worn is None:
            return self
        pairs = {name: (value, getattr(worn, name)) for name, value in vars(self).items()}
        return UpdateCounts(**{name: _COMBINED.get(name, max)(*v) for name, v in pairs.items()})

    def summary(self, largest_kept: float, system: System) -> dict[str, Any]:
        """Summary entries with the largest wear kept in the gap and the volumes lost.

        Empty without updates.
        """
        if self.updates == 0:
            return {}
        return {
            "geometry_updates": self.updates,
            "geometry_largest_kept": largest_kept,
            "geometry_smallest_scaled_jacobian": self.quality,
            **_lost_volumes(system),
            "geometry_volume_error": self.volume_error,
            "geometry_change": self.change,
            "geometry_temperature_error": self.heat_error,
            "geometry_meshed_anew": self.meshed_anew,
            "geometry_remeshing_error": self.carrying_error,
        }


def _lost_volumes(system: System) -> dict[str, Any]:
    """Volumes that the meshes have lost, by body; of a contact without a name by side [m³]."""
    model, lost = system.model, system.lost
    if not model.named:
        return {f"geometry_volume_{side}_m3": float(v) for side, v in enumerate(lost[0], 1)}
    found = {body.name: {"geometry_volume_m3": 0.0} for body in model.bodies}
    for interface, volumes in zip(model.interfaces, lost, strict=True):
        for body, volume in zip(interface.bodies, volumes, strict=True):
            found[model.bodies[body].name]["geometry_volume_m3"] += float(volume)
    return {"bodies": found}
