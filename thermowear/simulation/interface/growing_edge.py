"""Edges that travel over the contact: points with pointwise contact, error norm, step sizes.

They are the edge of a contact that grows by wear, and the border of each layer that is worn
through; the latter wear on all the time, and need no step sizes of their own.

At a distance ξ from an edge that travels at a speed c the pressure rises as ``ξ^θ``,
``tan πθ = 2 c / (E* k v)``: ``2 p / E*`` is the slope of the elastic deflection, ``k v p / c`` that
of the wear depth (from ``k v p / c + 2 / (π E*) ∫ p(s) / (s - ξ) ds = const``, a singular integral
equation; Muskhelishvili, Singular Integral Equations, 1953, ch. 12). Without wear θ is 1/2, and p
falls to zero smoothly; where wear dominates, θ < 1/4, it is nearly a jump.

A point with pointwise contact begins to press suddenly when the edge of the wear reaches it. The
maximum norm of the difference of two histories then measures the time of that event and does not
decrease with the step. The norms that converge are the mean over the contact area and the
difference of the largest pressures, at any points.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...contact.wear.implicit_step import WearRates
from ...contact.wear.wear_edge import closing_times, edge_points, has_passed, rough_points
from ..system.system import System
from .condensed_method import ContactSolver
from .sdirk import InterfaceState, InterfaceWear

Note = Callable[[str], None] | None
"""Function that is called with a note for the user."""

_RISE = 0.1
"""Fraction of the rise of the largest pressure in a step that counts as its error."""
_MOST_POINTS = 3000
"""Largest number of points with pointwise contact: their matrices are dense."""
_WEAK = (
    f"more than {_MOST_POINTS} contact points lie at the edge of the wear: contact is weak there, "
    "and the pressure at the edge less accurate; faces whose nodes lie opposite each other have "
    "fewer points"
)
_DELAY = 0.03
"""Delay of the end of a step behind the expected time of reaching a point, relative to the step."""
_STEP_AFTER_CONTACT = 0.4
"""Step after reaching a point, relative to the time in which wear takes up its deflection."""


class GrowingEdge:
    """Edge of the wear in a contact that may grow by wear, and borders between layers.

    Attributes
    ----------
    method : ContactSolver
    wear : InterfaceWear
    """

    def __init__(self, system: System, method: ContactSolver, wear: InterfaceWear, note: Note):
        self.method, self.wear, self._note = method, wear, note
        self._facets, self._basis = system.contacts.facets, system.basis
        self._weights = system.weights

    def partial_zones(self, worn: np.ndarray) -> list[np.ndarray]:
        """Points within each edge that is on the face: worn ones, and those below each layer."""
        zones = [np.any(worn > 0.0, axis=0)]
        if self.wear.layered:
            zones += self.wear.below_layers(worn)
        return [zone for zone in zones if zone.any() and not zone.all()]

    def points(
        self,
        worn: np.ndarray,
        pressure: np.ndarray | None = None,
        before: np.ndarray | None = None,
    ) -> np.ndarray | None:
        """Points with pointwise contact conditions, shape (n,), None without any.

        Parameters
        ----------
        worn : ndarray, shape (n_wearing, n) [m]
        pressure : ndarray, shape (n,), optional
            Pressure [Pa].
        before : ndarray of bool, shape (n,), optional
            Points used for that pressure: kept until it is smooth there.
        """
        zones = self.partial_zones(worn)
        if before is None and not zones:
            return None
        points = np.zeros(worn.shape[1], dtype=bool)
        for zone in zones:
            points |= edge_points(self._facets, self._basis, zone)
        if before is not None:
            assert pressure is not None
            points |= before & rough_points(self._facets, self._basis, self._weights, pressure)
        if np.count_nonzero(points) > _MOST_POINTS:
            if self._note is not None:
                self._note(_WEAK)
            self._note = None  # once
            return None
        return points if points.any() else None

    def difference(
        self, before: InterfaceState, one: InterfaceState, other: InterfaceState
    ) -> float:
        """Difference of two pressures, the maximum norm where they are continuous in time [Pa].

        A step that reaches a point in its last stage wears it too late and loads it too much,
        possibly alike in both histories: a rise of the largest pressure therefore counts as well.
        If the edge has passed beyond its points, the largest pressure itself is returned.
        """
        change = np.abs(one.pressure - other.pressure)
        assert one.pointwise is not None
        earlier, now = (np.any(state.worn > 0.0, axis=0) for state in (before, one))
        if has_passed(self._basis, one.pointwise, earlier, now):
            return float(one.pressure.max())
        pressing = (one.pressure > 0.0) | (other.pressure > 0.0)
        area = float(pressing @ self._weights)
        mean = float(change @ self._weights) / area if area > 0.0 else 0.0
        largest, expected, former = (v.pressure.max() for v in (one, other, before))
        return float(max(mean, abs(largest - expected), _RISE * (largest - former)))

    def steps(
        self,
        states: tuple[InterfaceState, InterfaceState, InterfaceState],
        step: float,
        rates: WearRates,
    ) -> tuple[float, float]:
        """Step sizes that end right behind a time at which the edge of the wear reaches a point.

        See `WearProblem.edge_steps`; the wear rates are those under the conditions of the last
        state. The step after one in which a point has begun to press is short.
        """
        start, middle, end = (state.contact.apart for state in states)
        if start is None or middle is None or end is None:
            return 0.0, np.inf
        times = closing_times(start, middle, end, step)
        reached = float(times[end == 0.0].min(initial=np.inf))
        left = float(times[end > 0.0].min(initial=np.inf)) - step
        following = left + _DELAY * max(left, step)
        begun = (end == 0.0) & (states[0].pressure == 0.0)
        if begun.any():
            slope = rates.slope(states[2].pressure).point[begun]
            following = min(
                following, _STEP_AFTER_CONTACT * self._take_up_time(states[2], begun, slope)
            )
        return (1 + _DELAY) * reached if np.isfinite(reached) else 0.0, following

    def _take_up_time(self, state: InterfaceState, points: np.ndarray, slope: np.ndarray) -> float:
        """Shortest time in which wear takes up the elastic deflection under single points [s]."""
        assert state.pointwise is not None
        point_compliance = self.method.point_compliance(state.pointwise)[points]
        return float((point_compliance[slope > 0.0] / slope[slope > 0.0]).min(initial=np.inf))
