"""Steady pressure of the discrete interface: the limit of its running-in."""

from __future__ import annotations

import numpy as np

from .contact_solver import ContactSolver
from .growing_edge import GrowingEdge
from .interface_wear import InterfaceWear
from .sdirk import InterfaceState
from .steady import SteadyState


class SteadyLimit:
    """Limit of the running-in in the pressure space of its contact; the last one is cached.

    Points that an edge of the wear has left behind keep pointwise contact where the pressure space
    is too coarse for the steady pressure. The limit is then that of the space with these points.
    """

    def __init__(self, method: ContactSolver, wear: InterfaceWear, edge: GrowingEdge):
        self._method, self._wear, self._edge = method, wear, edge
        self._last: tuple[SteadyState, bytes | None, np.ndarray] | None = None

    def pressure(self, steady: SteadyState, state: InterfaceState) -> np.ndarray:
        """Steady pressure that a state approaches, shape (n,) [Pa]."""
        points = state.pointwise
        if points is not None and self._edge.partial_zones(state.worn):
            points = None  # not yet the limit
        key = None if points is None else points.tobytes()
        if self._last is None or self._last[0] is not steady or self._last[1] != key:
            conditions = steady.contact.conditions
            rates = self._wear.final_rates(conditions)
            found = self._method.steady(steady.wear.pressure, rates, conditions, points)
            self._last = steady, key, found
        return self._last[2]
