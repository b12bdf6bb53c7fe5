"""Edge of the stick zone within the coefficients of pressure and shear, and wear across it.

In partial slip the pressure ``p* = p - |t|/mu`` of the stick zone takes no part in the slip. It is
that of a smooth contact (Jäger 1998, Ciavarella 1998), with ``p*²`` linear at its edge: a quadratic
function, fitted within the zone, locates the edge inside of a coefficient.

A coefficient across the edge sticks in a part θ of its width. Mean pressure times mean slip would
wear all of it until it carries nothing, the next one after it, and the zone would lose an element.
But only the part outside slips and wears. It is unloaded when it is as deep as the opening next to
a punch that ends at the edge. Of similar coefficients with the width h, that takes the mean depth
``ε (λ - p*)``, ``ε = ε_0 (1 - θ)/θ``, so that its pressure is

    λ - p* - X/ε,      X: mean depth worn since it sticks in a part.

Where nothing sticks, ε is infinite, and the wear that of all of the coefficient. The shear is
bounded by ``mu (λ - p*)``, with p* of the time at which wear begins there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ..operators.pressure import Basis, scaled
from ..search.contacts import Contacts
from .stick_slip_state import Status, StickSlipState

_END = 0.5
"""End of a punch beyond the place of its last coefficient, by its width over the degree of the
pressure."""
_OPENING = 4 / np.pi
"""ε_0 by the width over E*, measured against closed forms of punches on half-planes."""
_LEAST = 1e-3
"""Least part that sticks of a coefficient of which a part slips, and least part that slips."""
_FITTED, _FEWEST = (12, 40), (4, 20)
"""Number of coefficients that the quadratic function is fitted to, in sections and in space, and
the least of them."""
_NEAR = 14.0
"""Their largest distance, by the width."""
_SMOOTHINGS = 2


@dataclass(frozen=True)
class StickZone:
    """Stick zone of a cycle, or of an instant.

    Attributes
    ----------
    part : ndarray, shape (m,)
        θ: 1 inside, 0 outside.
    unsheared : ndarray, shape (m,)
        p* [Pa].
    edge : ndarray, shape (k, gdim)
        Points of its edge [m].
    crossed : ndarray of int, shape (k,)
        Coefficient that each lies in.
    """

    part: np.ndarray
    unsheared: np.ndarray
    edge: np.ndarray
    crossed: np.ndarray


@dataclass(frozen=True)
class StickEdge:
    """Coefficients as cells with places and widths, see `stick_edge`; t tangential directions.

    Attributes
    ----------
    places : ndarray, shape (m, gdim)
        [m]
    axes : ndarray, shape (t, m, gdim)
        Tangential directions there.
    spread : ndarray, shape (m, t, t)
        Squared widths, along the axes [m²].
    means : csr_array, shape (m, m)
        Means with each function of functions with these coefficients.
    softness : ndarray, shape (m,)
        1/E* [1/Pa].
    friction : ndarray, shape (m,)
    degrees : ndarray, shape (m,)
        Polynomial degrees of the pressure.
    """

    places: np.ndarray
    axes: np.ndarray
    spread: np.ndarray
    means: sp.csr_array
    softness: np.ndarray
    friction: np.ndarray
    degrees: np.ndarray

    @cached_property
    def _next(self) -> sp.csr_array:
        """Coefficients that overlap."""
        return (self.means != 0.0).astype(float).tocsr()

    def _grown(self, chosen: np.ndarray) -> np.ndarray:
        """Chosen coefficients and those next to them, bool (m,)."""
        return self._next @ chosen.astype(float) > 0.0

    def after(self, cycle: Sequence[StickSlipState]) -> StickSlipState:
        """End of a cycle with its stick zone, from the states from its start to its end."""
        last, zone = cycle[-1], self.zone(cycle, True)
        excess = np.where(zone.part > 0.0, last.excess, 0.0)
        crossed = (zone.part > 0.0) & (zone.part < 1.0)
        found = np.where(crossed, zone.unsheared, 0.0)
        unsheared = np.where(excess > 0.0, last.unsheared, found)
        return replace(last, part=zone.part, excess=excess, unsheared=unsheared)

    def zone(self, states: Sequence[StickSlipState], is_cycle: bool) -> StickZone:
        """Stick zone of the states from the start to the end of a cycle, or of one state."""
        stuck, unsheared = self._carried(states, is_cycle)
        before, part = states[0].part, stuck.astype(float)
        whole = stuck & ((before == 0.0) | (before == 1.0))
        slips = np.any([state.pressure > 0.0 for state in states], axis=0) & ~stuck
        crossed = self._grown(slips) & self._grown(self._grown(whole)) & (slips | stuck)
        edge: list[np.ndarray] = []
        cut: list[int] = []
        for number, found in self._distances(np.flatnonzero(crossed), whole, unsheared**2):
            within, outwards, width = found
            inner = within / width + 1.0 - _END / self.degrees[number]
            if inner < 1.0 if stuck[number] else inner > 0.0:
                edge.append(self.places[number] + within * outwards)
                cut.append(number)
                inner = np.clip(inner, _LEAST, 1.0 - _LEAST)
            part[number] = np.clip(inner, 0.0, 1.0)
        points = np.reshape(edge, (-1, self.places.shape[1]))
        return StickZone(part, unsheared, points, np.array(cut, dtype=int))

    def _carried(
        self, states: Sequence[StickSlipState], is_cycle: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients that stick in all states, and p* (m,) [Pa].

        In a cycle shear that remains in the stick zone has no part in its slip: the range counts.
        """
        moved = states[1:] if is_cycle else states
        stuck = np.all([state.status == Status.STICK for state in moved], axis=0)
        pressure = np.array([state.pressure for state in states])
        shear = np.array([state.shear for state in states])
        friction = np.where(self.friction > 0.0, self.friction, np.inf)
        least = (pressure - np.linalg.norm(shear, axis=2) / friction).min(axis=0)
        if is_cycle:
            apart = [np.linalg.norm(shear - one, axis=2).max(axis=0) for one in shear]
            least = np.maximum(least, pressure.min(axis=0) - np.max(apart, axis=0) / (2 * friction))
        return stuck, np.maximum(least, 0.0)

    def _distances(
        self, numbers: np.ndarray, whole: np.ndarray, square: np.ndarray
    ) -> Iterator[tuple[int, tuple[float, np.ndarray, float]]]:
        """Coefficients, and what `_distance` tells of those of which it can.

        From p*² of coefficients that stick wholly. Pressures alternate next to the edge, between
        coefficients: they are smoothed there, if enough of them are left.
        """
        smooth, dim = sp.eye_array(len(square), format="csr"), len(self.axes) - 1
        for _ in range(_SMOOTHINGS):
            deeper = whole & ~self._grown(~whole)
            if deeper.sum() < _FEWEST[dim]:
                break
            square, smooth, whole = self.means @ square, self.means @ smooth, deeper
        inside = np.flatnonzero(whole)
        if len(inside) < _FEWEST[dim]:
            return
        tree = cKDTree(self.places[inside])
        nearest = tree.query(self.places[numbers], min(_FITTED[dim], len(inside)))[1]
        for number, near in zip(map(int, numbers), inside[nearest], strict=True):
            found = self._distance(number, near, square, smooth)
            if found is not None:
                yield number, found

    def _distance(
        self, number: int, near: np.ndarray, square: np.ndarray, smooth: sp.csr_array
    ) -> tuple[float, np.ndarray, float] | None:
        """Distance of a coefficient from the edge, outward direction, and width across it.

        From p*² of coefficients near it, smoothed as a quadratic function of the places is; None if
        they are too few, or equal.
        """
        size = np.sqrt(np.trace(self.spread[number]) / len(self.axes))
        at = (self.places - self.places[number]) @ self.axes[:, number].T / size
        near = near[np.linalg.norm(at[near], axis=1) < _NEAR]
        columns = np.column_stack([np.ones(len(at)), at, (at**2).sum(axis=1) / 2])
        if len(near) <= columns.shape[1]:
            return None
        value, *slopes, bend = np.linalg.lstsq(smooth[near] @ columns, square[near])[0]
        slope = float(np.linalg.norm(slopes))
        if slope == 0.0:
            return None
        outwards = -np.array(slopes) / slope
        root = np.sqrt(max(slope**2 - 2 * bend * value, 0.0))
        width = np.sqrt(outwards @ self.spread[number] @ outwards)
        return 2 * size * value / (slope + root), outwards @ self.axes[:, number], float(width)

    def opening(self, part: np.ndarray) -> np.ndarray:
        """ε of coefficients that stick in these parts, infinite where nothing sticks, (m,) [m/Pa].

        Those that stick wholly wear as if nothing did, if they slip nevertheless.
        """
        size = np.sqrt(np.trace(self.spread, axis1=1, axis2=2) / len(self.axes))
        crossed = (part > 0.0) & (part < 1.0)
        slips = np.divide(1.0 - part, part, out=np.full(len(part), np.inf), where=crossed)
        return _OPENING * size * self.softness * slips

    def slip(self, mean: np.ndarray, pressure: np.ndarray, part: np.ndarray) -> np.ndarray:
        """Mean slips (m,) where coefficients stick in these parts, from those of all of them [m].

        Where the pressure is smooth, the slips of all coefficients together are right. Where it is
        gone beyond the edge, a coefficient that sticks by its mean slips in its outer part, as the
        slip grows with the power 3/2 of the distance.

        Parameters
        ----------
        mean, pressure, part : ndarray, shape (m,)
            Mean slip [m], pressure [Pa], and part that sticks.
        """
        crossed, slips = np.flatnonzero((part > 0.0) & (part < 1.0)), mean > 0.0
        near, outside, found = self._next[crossed], 1.0 - part[crossed], mean.copy()
        beyond = near.multiply(mean).max(axis=1).toarray().ravel()
        pressed = near @ (slips * pressure) / np.maximum(near @ slips.astype(float), 1.0)
        own = np.maximum(pressure[crossed], np.finfo(float).tiny)
        share = outside**2.5 / ((1.0 + outside) ** 2.5 - outside**2.5)
        share *= np.maximum(own - pressed, 0.0) / own
        found[crossed] = np.maximum(mean[crossed], share * beyond)
        return found


def stick_edge(
    contacts: Contacts,
    basis: Basis,
    frame: np.ndarray,
    softness: np.ndarray,
    friction: np.ndarray,
    degrees: np.ndarray,
) -> StickEdge:
    """Cells of the coefficients: a hat function stands for a cell of half its support.

    Parameters
    ----------
    contacts : Contacts
    basis : ndarray or csr_array, shape (n, m)
        Ψ.
    frame : ndarray, shape (t, n, gdim)
        Tangential directions.
    softness : ndarray, shape (n,)
        1/E* at the points [1/Pa].
    friction : ndarray, shape (m,)
        Coefficient of friction.
    degrees : ndarray, shape (m,)
        Polynomial degrees of the pressure.
    """
    weighted = sp.csr_array(scaled(contacts.weights, basis)).T.tocsr()
    areas = weighted.sum(axis=1)
    mean = sp.diags_array(1 / areas) @ weighted
    places, axes = mean @ contacts.points, np.array([mean @ along for along in frame])
    axes /= np.linalg.norm(axes, axis=2, keepdims=True)
    entries = mean.tocoo()
    of, point = entries.coords
    at = np.einsum("tki,ki->kt", axes[:, of], contacts.points[point] - places[of])
    spread = np.zeros((len(places), len(frame), len(frame)))
    np.add.at(spread, of, 6 * entries.data[:, None, None] * at[:, :, None] * at[:, None, :])
    means = (mean @ sp.csr_array(basis)).tocsr()
    return StickEdge(places, axes, spread, means, mean @ softness, friction, degrees)


def radius_of(edge: np.ndarray, turns: bool) -> float:
    """Radius of a stick zone with points (k, gdim) of its edge; NaN of too few [m].

    Of a circle through the points; in sections half of the width, if the bodies are turned about an
    axis the distance from it.
    """
    if turns:
        return float(edge[:, 0].mean()) if len(edge) else np.nan
    if len(edge) < edge.shape[1]:
        return np.nan
    at = edge - edge.mean(axis=0)
    at = at @ np.linalg.svd(at, full_matrices=False)[2][:-1].T
    if at.shape[1] == 1:
        return float(np.ptp(at)) / 2
    squares = (at**2).sum(axis=1)
    *centre, rest = np.linalg.lstsq(np.column_stack([2 * at, np.ones(len(at))]), squares)[0]
    return float(np.sqrt(rest + np.dot(centre, centre)))
