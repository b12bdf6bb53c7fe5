"""Fixed-point iteration for state-dependent interface conditions, with Anderson acceleration."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from ...contact.operators.heat import ThermalState
from ...contact.solvers.anderson import AndersonMixing
from ...errors import ComputationError
from ..system.conditions import ConditionModel, InterfaceConditions

_DAMPED = 0.5
_NEAR = 0.05
"""Relative residual below which iterates are mixed; above it, that may lead to another state."""
_ITERATIONS = 100
_LEAST_RISE = 1.0  # K


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
    Anderson mixing takes over.

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
    for _ in range(_ITERATIONS):
        conditions = conditions_of(iterate)
        found = respond(conditions)
        if conditions_of(found).same_as(conditions):
            model.require_friction(time, found.pressure, found.faces)
            return conditions, found
        scale = _scales(found)
        before = _vector(iterate) / scale
        residual = _vector(found) / scale - before
        if mixing is None and np.abs(residual).max() <= _NEAR:
            mixing = AndersonMixing()
        following = before + _DAMPED * residual if mixing is None else mixing.next(before, residual)
        iterate = _trial(following * scale, found)
    raise ComputationError(failure)


def _vector(state: Any) -> np.ndarray:
    """Pressure and temperature rises of the faces in a state."""
    return np.concatenate([state.pressure, *(() if state.faces is None else state.faces.rise)])


def _scales(found: Any) -> np.ndarray:
    """Scale of each entry of the vector: the largest pressure, and rise, of the last response."""
    pressures, rises = np.split(np.abs(_vector(found)), [len(found.pressure)])
    kelvin = max(float(rises.max(initial=0.0)), _LEAST_RISE)
    return np.repeat([float(pressures.max()) or 1.0, kelvin], [len(pressures), len(rises)])


def _trial(vector: np.ndarray, found: Any) -> Trial:
    """State of a vector, with the contact set of the last response."""
    count, least = len(found.pressure), 1e-9 * found.pressure.max()
    pressure, *rises = np.split(vector, [count] if found.faces is None else [count, 2 * count])
    pressing = np.where(found.pressure > 0, np.maximum(pressure, least), 0.0)
    faces = None if found.faces is None else ThermalState((rises[0], rises[1]), found.faces.flux)
    return Trial(pressing, faces, found.worn)
