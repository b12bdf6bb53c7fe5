"""Fixed-point iteration for state-dependent interface conditions, with Anderson acceleration."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from ...contact.operators.exchange_matrix import ThermalState
from ...contact.solvers.coupled_positions import AndersonMixing
from ...errors import ComputationError
from ..system.conditions import ConditionModel, InterfaceConditions

_DAMPED = 0.5
_NEAR = 0.05
"""Relative residual below which iterates are mixed; above it, that may lead to another state."""
_ITERATIONS = 100
_LEAST_RISE = 1.0  # K
_PARTLY, _STEEP = 0.03, 0.3
"""Pressure up to which imperfect contact conducts in part, relative to the largest one, and damping
of its iteration, as the conductance is steep there."""
_AGREES = 1e-8
"""Largest residual, relative to its scales, of a state with imperfect contact."""
_REMEMBERED = 20
"""Number of iterates mixed there; several points may be at the border."""


Found = TypeVar("Found", bound=Any)
"""State with the `pressure`, `faces` and `worn` that interface conditions depend on."""


@dataclass(frozen=True)
class Trial:
    """Iterate of the fixed-point iteration."""

    pressure: np.ndarray
    faces: ThermalState | None
    worn: np.ndarray


def self_consistent(
    model: ConditionModel,
    time: float,
    start: Any,
    respond: Callable[[InterfaceConditions], Found],
    failure: str,
    closed: np.ndarray | None = None,
) -> tuple[InterfaceConditions, Found]:
    """Find a state that is consistent with its own conditions.

    The iteration begins with damping by one half: among several states it converges to the one
    that slow heating would reach, as states unstable under heating repel it. Near the fixed point
    Anderson mixing takes over. If sets of closed points return, none of them is consistent, see
    `imperfect_contact`.

    Parameters
    ----------
    model : ConditionModel
    time : float
        [s]
    start : Trial
        Or another state with its attributes.
    respond : callable
        State under given conditions.
    failure : str
        Message of the error if the iteration does not converge.
    closed : ndarray of bool, shape (n,), optional
        Points that exchange heat by contact; by default the points in contact of each state.

    Raises
    ------
    ComputationError
    """

    def conditions_of(state: Any) -> InterfaceConditions:
        touching = state.pressure > 0 if closed is None else closed
        return model.at(time, state.pressure, state.faces, touching, state.worn)

    iterate, mixing = start, None
    sets: list[bytes] = []
    for _ in range(_ITERATIONS):
        conditions = conditions_of(iterate)
        found = respond(conditions)
        if conditions_of(found).same_as(conditions):
            model.require_friction(time, found.pressure, found.faces)
            return conditions, found
        sets.append((found.pressure > 0).tobytes())
        if not model.depends_on_state and sets[-1] in sets[:-1]:
            break  # nothing but the set counts, and it has returned
        before, residual, scale = _residual(iterate, found)
        if mixing is None and np.abs(residual).max() <= _NEAR:
            mixing = AndersonMixing()
        following = before + _DAMPED * residual if mixing is None else mixing.next(before, residual)
        iterate = _trial(following * scale, found, found.pressure > 0)
    if closed is None and sets[-1] != sets[-2]:
        return imperfect_contact(model, time, found, respond, failure)
    raise ComputationError(failure)


def imperfect_contact(
    model: ConditionModel,
    time: float,
    start: Any,
    respond: Callable[[InterfaceConditions], Found],
    failure: str,
) -> tuple[InterfaceConditions, Found]:
    """Find a state with points that touch without pressure and conduct in part.

    Where points that exchange heat part, and press once they are insulated, no set of closed points
    is consistent: contact is imperfect there (J.R. Barber, J. Appl. Mech. 45 (1978) 87). The
    conductance then rises with the pressure up to 3 % of the largest one.

    Parameters as in `self_consistent`; the states have an attribute `touching`.

    Raises
    ------
    ComputationError
    """
    partly, iterate = _PARTLY * float(start.pressure.max()), start
    mixing = AndersonMixing(_REMEMBERED)
    for _ in range(_ITERATIONS):
        touching = np.minimum(iterate.pressure / partly, 1.0)
        conditions = model.at(time, iterate.pressure, iterate.faces, touching, iterate.worn)
        found = respond(conditions)
        if iterate.faces is None:
            iterate = Trial(iterate.pressure, found.faces, iterate.worn)
        before, residual, scale = _residual(iterate, found)
        if np.abs(residual).max() <= _AGREES:
            model.require_friction(time, found.pressure, found.faces)
            partial = np.any((touching > 0.0) & (touching < 1.0))
            return conditions, replace(found, touching=touching if partial else None)
        steep = np.ones(len(before))
        steep[: len(touching)][touching < 1.0] = _STEEP
        following = mixing.next(before, steep * residual)
        iterate = _trial(following * scale, found, np.ones(len(touching), dtype=bool))
    raise ComputationError(failure)


def _residual(iterate: Any, found: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Scaled vector of an iterate, that of its response less it, and the scales."""
    scale = _scales(found)
    before = _vector(iterate) / scale
    return before, _vector(found) / scale - before, scale


def _vector(state: Any) -> np.ndarray:
    """Pressure and temperature rises of the faces in a state."""
    return np.concatenate([state.pressure, *(() if state.faces is None else state.faces.rise)])


def _scales(found: Any) -> np.ndarray:
    """Scale of each entry of the vector: the largest pressure, and rise, of the last response."""
    pressures, rises = np.split(np.abs(_vector(found)), [len(found.pressure)])
    kelvin = max(float(rises.max(initial=0.0)), _LEAST_RISE)
    return np.repeat([float(pressures.max()) or 1.0, kelvin], [len(pressures), len(rises)])


def _trial(vector: np.ndarray, found: Any, pressing: np.ndarray) -> Trial:
    """State of a vector, with pressure at some points (n,) only."""
    count, least = len(found.pressure), 1e-9 * found.pressure.max()
    pressure, *rises = np.split(vector, [count] if found.faces is None else [count, 2 * count])
    pressure = np.where(pressing, np.maximum(pressure, least), 0.0)
    faces = None if found.faces is None else ThermalState((rises[0], rises[1]), found.faces.flux)
    return Trial(pressure, faces, found.worn)
