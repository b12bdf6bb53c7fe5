"""Steady pressure of the discrete interface: the limit of its running-in."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .growing_edge import GrowingEdge
from .sdirk import InterfaceState
from .steady import SteadyState


@dataclass(frozen=True)
class SteadyLimit:
    """Limit of a running-in in the pressure space of its contact.

    Attributes
    ----------
    steady : SteadyState
    edge : ndarray of bool or None, shape (n,)
        Points with pointwise contact of the state that approaches it.
    points : ndarray of bool or None, shape (n,)
        Those that it keeps.
    pressure : ndarray, shape (n,) [Pa]
    """

    steady: SteadyState
    edge: np.ndarray | None
    points: np.ndarray | None
    pressure: np.ndarray


def steady_limit(
    edge: GrowingEdge, steady: SteadyState, state: InterfaceState, last: SteadyLimit | None
) -> SteadyLimit:
    """Limit that a state approaches.

    Points that an edge of the wear has left behind keep pointwise contact where the pressure space
    is too coarse for the steady pressure. The limit is then that of the space with these points.

    Parameters
    ----------
    edge : GrowingEdge
    steady : SteadyState
    state : InterfaceState
    last : SteadyLimit or None
        An earlier limit, for its pressure if the space is the same.
    """
    points = state.pointwise
    if points is not None and edge.partial_zones(state.worn):
        points = None  # not yet the limit
    if last is not None and last.steady is steady and _same(last.points, points):
        return replace(last, edge=state.pointwise)
    conditions = steady.contact.conditions
    rates = edge.wear.final_rates(conditions)
    pressure = edge.method.steady(steady.contact.pressure, rates, conditions, points)
    return SteadyLimit(steady, state.pointwise, points, pressure)


def _same(one: np.ndarray | None, other: np.ndarray | None) -> bool:
    return one is other or (one is not None and other is not None and np.array_equal(one, other))
