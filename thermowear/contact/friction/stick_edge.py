"""Edge of the stick zone within the coefficients of pressure and shear, and wear across it.

In partial slip the pressure ``p* = p - |t|/mu`` of the stick zone takes no part in the slip. It is
that of a smooth contact (Jäger 1998, Ciavarella 1998), with ``p*²`` linear at its edge: a quadratic
function, fitted within the zone, locates the edge inside of a coefficient.

A coefficient across the edge sticks in a part θ of its width. Mean pressure times mean slip would
wear all of it until it carries nothing, the next one after it, and the zone would lose an element.
But only the part outside slips and wears. It is unloaded when it is as deep as the opening next to
a punch that ends at the edge. Of similar coefficients with the width h, that takes the mean depth
``ε (λ - p*)``, ``ε = h/E* (1 - θ)/θ``, so that its pressure is

    λ - p* - X/ε,      X: mean depth worn since there is a stick zone.

Where nothing sticks, ε is infinite, and the wear that of all of the coefficient. The shear is
bounded by ``mu (λ - p*)``, with p* of the time at which wear begins there.

Wear also holds the edge back. The more is worn, the closer the bodies come, and the edge moves
outwards, over what is worn already. At the distance s beyond an edge with ``p* = K √s`` within, the
gap of the smooth contact is ``4K s^(3/2)/3E*``, and slip and wear grow with this power, too: where
ρ times this gap has been worn, the edge moves less by the factor 1 + ρ. If ρ grows in proportion to
the way without wear, ``ln(1 + ρ)/ρ`` of the way is left. Close to the edge nothing relieves the
pressure: ρ is that of a wear that does not.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ..operators.pressure import Basis, scaled
from ..search.pairing import Contacts
from .stick_slip_state import Status, StickSlipState

_Each = TypeVar("_Each", float, np.ndarray)

_END = 0.55, 0.58
"""End of a punch beyond the place of its last coefficient, by the width, in sections and in space.

Measured: flat punches with this opening are then as stiff as their closed forms wherever within a
coefficient they end, to 0.005 h (quadratic pressures to 0.05 h)."""
_LEAST = 1e-3
"""Least part that sticks of a coefficient of which a part slips, and least part that slips."""
_FITTED, _FEWEST = (12, 40), (4, 20)
"""Number of coefficients that the quadratic function is fitted to, in sections and in space, and
the least of them."""
_EQUALLY_FAR = 1.0 + 1e-9
"""All that are as far as the last of them, to this factor, belong to them: grids have many."""
_NEAR = 14.0
"""Their largest distance, by the width."""
_SMOOTHINGS, _FITS = 4, 4
"""Smoothings of p*, and fits until the smoothed root of the quadratic function is that."""


@dataclass(frozen=True)
class StickZone:
    """Stick zone of a cycle, or of an instant.

    Attributes
    ----------
    part : ndarray, shape (m,)
        θ: 1 inside, 0 outside.
    onset : ndarray, shape (m,)
        Least part that stuck so far, before it is held back by wear.
    unsheared : ndarray, shape (m,)
        p* [Pa].
    edge : ndarray, shape (k, gdim)
        Points of its edge [m].
    crossed : ndarray of int, shape (k,)
        Coefficient that each lies in.
    """

    part: np.ndarray
    onset: np.ndarray
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
    """

    places: np.ndarray
    axes: np.ndarray
    spread: np.ndarray
    means: sp.csr_array
    softness: np.ndarray
    friction: np.ndarray

    @property
    def _end(self) -> float:
        return _END[len(self.axes) - 1]

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
        crossed = (zone.part > 0.0) & (zone.part < 1.0)
        kept = cycle[0].crossed & (zone.part > 0.0)
        unsheared = np.where(kept, last.unsheared, np.where(crossed, zone.unsheared, 0.0))
        return replace(last, part=zone.part, onset=zone.onset, unsheared=unsheared)

    def zone(self, states: Sequence[StickSlipState], is_cycle: bool) -> StickZone:
        """Stick zone of the states from the start to the end of a cycle, or of one state."""
        stuck, unsheared = self._carried(states, is_cycle)
        before, part = states[0].part, stuck.astype(float)
        whole = stuck & ((before == 0.0) | (before == 1.0))
        slips = np.any([state.pressure > 0.0 for state in states], axis=0) & ~stuck
        crossed = self._grown(slips) & self._grown(self._grown(whole)) & (slips | stuck)
        onset, last = part.copy(), states[-1]
        edge: list[np.ndarray] = []
        cut: list[int] = []
        for number, found in self._distances(np.flatnonzero(crossed), whole, unsheared):
            within, outwards, width, rise = found
            inner = onset[number] = self.sticking(within, width)
            if before.any():
                onset[number] = min(inner, last.onset[number])
                gap = gap_beside(onset[number] - 1.0 + self._end, width, rise)
                way = held_back(inner - onset[number], last.unrelieved[number] / gap)
                inner = max(onset[number] + way, min(inner, before[number]))
            if inner < 1.0 if stuck[number] else inner > 0.0:
                away = (inner - self.sticking(0.0, width)) * width
                edge.append(self.places[number] + away * outwards)
                cut.append(number)
                inner = np.clip(inner, _LEAST, 1.0 - _LEAST)
            part[number] = np.clip(inner, 0.0, 1.0)
        points = np.reshape(edge, (-1, self.places.shape[1]))
        return StickZone(part, onset, unsheared, points, np.array(cut, dtype=int))

    def _carried(
        self, states: Sequence[StickSlipState], is_cycle: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients that stick in all states, and p* (m,) [Pa].

        In a cycle, shear that remains in the stick zone has no part in its slip: any two states
        bound p* by their mean pressure and half the difference of their shears.
        """
        moved = states[1:] if is_cycle else states
        stuck = np.all([state.status == Status.STICK for state in moved], axis=0)
        pressure = np.array([state.pressure for state in states])
        shear = np.array([state.shear for state in states])
        friction = np.where(self.friction > 0.0, self.friction, np.inf)
        others = zip(pressure, shear if is_cycle else -shear, strict=True)
        least = [
            (pressure + p) / 2 - np.linalg.norm(shear - t, axis=2) / (2 * friction)
            for p, t in others
        ]
        return stuck, np.maximum(np.min(least, axis=(0, 1)), 0.0)

    def _distances(
        self, numbers: np.ndarray, whole: np.ndarray, unsheared: np.ndarray
    ) -> Iterator[tuple[int, tuple[float, np.ndarray, float, float]]]:
        """Coefficients, and what `_distance` tells of those of which it can.

        From p* of coefficients that stick wholly. It alternates next to the edge, between
        coefficients: it is smoothed there, if enough of them are left.
        """
        smooth, dim = sp.eye_array(len(whole), format="csr"), len(self.axes) - 1
        for _ in range(_SMOOTHINGS):
            deeper = whole & ~self._grown(~whole)
            if deeper.sum() < _FEWEST[dim]:
                break
            smooth, unsheared, whole = self.means @ smooth, self.means @ unsheared, deeper
        inside = np.flatnonzero(whole)
        if len(inside) < _FEWEST[dim]:
            return
        tree = cKDTree(self.places[inside])
        count = min(_FITTED[dim], len(inside))
        farthest = tree.query(self.places[numbers], [count])[0][:, 0]
        nearest = tree.query_ball_point(self.places[numbers], _EQUALLY_FAR * farthest)
        for number, near in zip(map(int, numbers), nearest, strict=True):
            found = self._distance(number, inside[near], smooth, unsheared)
            if found is not None:
                yield number, found

    def _distance(
        self, number: int, near: np.ndarray, smooth: sp.csr_array, unsheared: np.ndarray
    ) -> tuple[float, np.ndarray, float, float] | None:
        """Distance of a coefficient from the edge, outward direction, width across it, and K/E*.

        From p* of coefficients near it, the root of a quadratic function of the places, smoothed
        as that is; None if they are too few, or equal.
        """
        size = np.sqrt(np.trace(self.spread[number]) / len(self.axes))
        at = (self.places - self.places[number]) @ self.axes[:, number].T / size
        near = near[np.linalg.norm(at[near], axis=1) < _NEAR]
        columns = np.column_stack([np.ones(len(at)), at, (at**2).sum(axis=1) / 2])
        if len(near) <= columns.shape[1]:
            return None
        means, square, fitted = smooth[near], unsheared[near] ** 2, np.zeros(columns.shape[1])
        smoothed = means @ columns
        for _ in range(_FITS):  # smoothing lowers the root
            root = means @ np.sqrt(np.maximum(columns @ fitted, 0.0))
            fitted = np.linalg.lstsq(smoothed, square + smoothed @ fitted - root**2)[0]
        value, *slopes, bend = fitted
        slope = float(np.linalg.norm(slopes))
        if slope == 0.0:
            return None
        outwards = -np.array(slopes) / slope
        root = np.sqrt(max(slope**2 - 2 * bend * value, 0.0))
        width = np.sqrt(outwards @ self.spread[number] @ outwards)
        within = 2 * size * value / (slope + root)
        rise = float(np.sqrt(root / size)) * self.softness[number]
        return within, outwards @ self.axes[:, number], float(width), rise

    def sticking(self, within: _Each, width: float) -> _Each:
        """Part that sticks of coefficients so far within the edge, beyond 0 and 1 not crossed."""
        return within / width + 1.0 - self._end

    def opening(self, part: np.ndarray) -> np.ndarray:
        """ε of coefficients that stick in these parts, infinite where nothing sticks, (m,) [m/Pa].

        Those that stick wholly wear as if nothing did, if they slip nevertheless.
        """
        size = np.sqrt(np.trace(self.spread, axis1=1, axis2=2) / len(self.axes))
        crossed = (part > 0.0) & (part < 1.0)
        slips = np.divide(1.0 - part, part, out=np.full(len(part), np.inf), where=crossed)
        return size * self.softness * slips

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


def gap_beside(beyond: float, width: float, rise: float) -> float:
    """Mean by a hat function of the gap beside the edge of a smooth contact [m].

    Parameters
    ----------
    beyond : float
        Distance of the edge beyond the place of the function, by its width.
    width : float
        [m]
    rise : float
        K/E*, with the pressure ``K √s`` at the distance s within the edge [1/√m].
    """
    reach = np.maximum([1.0 - beyond, -beyond, -1.0 - beyond], 0.0) ** 3.5
    mean = 16 / 105 * float(reach @ [1.0, -2.0, 1.0])
    return max(rise * width**1.5 * mean, np.finfo(float).tiny)


def held_back(way: float, worn: float) -> float:
    """Way of the edge if ρ times the gap beside it has been worn, from that without wear."""
    return way * (float(np.log1p(worn)) / worn if worn > 0.0 else 1.0)


def stick_edge(
    contacts: Contacts,
    basis: Basis,
    frame: np.ndarray,
    softness: np.ndarray,
    friction: np.ndarray,
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
    return StickEdge(places, axes, spread, means, mean @ softness, friction)


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
