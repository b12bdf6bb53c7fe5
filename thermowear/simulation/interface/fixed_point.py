"""Fixed-point iteration for state-dependent interface conditions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from ...contact.operators.heat import ThermalState
from ...errors import ComputationError
from ..system.conditions import ConditionModel, InterfaceConditions
from .anderson import Mixing

_DAMPED = 0.5
_NEAR = 0.05
"""Relative residual below which iterates are mixed; above it, that may lead to another state."""
_TURNS = 100
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

    tried, mixing = start, None
    for _ in range(_TURNS):
        conditions = conditions_of(tried)
        found = respond(conditions)
        if conditions_of(found).settled(conditions):
            model.require_friction(time, found.pressure, found.faces)
            return conditions, found
        before, after = _stacked(tried, found), _stacked(found, found)
        missed = after - before
        if mixing is None and np.abs(missed).max() <= _NEAR:
            mixing = Mixing()
        following = before + _DAMPED * missed if mixing is None else mixing.next(before, missed)
        tried = _unstacked(following, found)
    raise ComputationError(failure)


def _scales(found: Any) -> tuple[float, float]:
    rise = 0.0 if found.faces is None else float(np.max(np.abs(found.faces.rise)))
    return float(found.pressure.max()) or 1.0, max(rise, _LEAST_RISE)


def _stacked(state: Any, found: Any) -> np.ndarray:
    """Dimensionless vector of a state, scaled by the pressure and rise of the last response."""
    pascal, kelvin = _scales(found)
    rises = () if state.faces is None else state.faces.rise
    return np.concatenate([state.pressure / pascal, *(rise / kelvin for rise in rises)])


def _unstacked(vector: np.ndarray, found: Any) -> Trial:
    """Inverse of `_stacked`, with the contact set of the last response."""
    pascal, kelvin = _scales(found)
    pressure, *rises = np.split(vector, 1 if found.faces is None else 3)
    pressing = np.where(found.pressure > 0, np.maximum(pressure, 1e-9), 0.0) * pascal
    if found.faces is None:
        return Trial(pressing, None, found.worn)
    rise = (rises[0] * kelvin, rises[1] * kelvin)
    return Trial(pressing, ThermalState(rise, found.faces.flux), found.worn)
