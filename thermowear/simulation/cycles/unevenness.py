"""Distance of reciprocating wear from its steady state.

In the steady state the gap closes at the same rate wherever the faces touch, see
`reciprocating_problem`. The ends of the faces are left out: at the turning points the edge of
the carrying body carries half the load, which no mesh resolves.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...contact.operators.pressure import dense
from ...contact.wear.swept_surface import SweptSurface
from ...contact.wear.track import StrokeGrid, StrokeGrids
from ..system.system import System
from .stroke import Position

_INNER = 0.9
"""Part of the faces that is compared."""

Unevenness = Callable[[np.ndarray, np.ndarray], float]
"""Largest relative deviation of wear rates from their mean, of the coefficients of the carrying
bodies (m,) and the nodal values of the swept ones (n_nodes,)."""


def unevenness(
    system: System, stroke: list[Position], track: StrokeGrids, functions: tuple[slice, ...]
) -> Unevenness:
    """Measure of the distance from the steady state of a stroke.

    In a section the rates of each face are compared with their mean; in space, where they depend on
    the length of the face along the stroke, the sums of opposite points in all positions with their
    mean, relative to the mean rate of the face that wears less.

    Parameters
    ----------
    system : System
        Bodies in the middle of the stroke.
    stroke : list of Position
    track : StrokeGrids
    functions : tuple of slice
        Range of the coefficients of each interface.
    """
    if system.contacts.in_space:
        return _by_closing(stroke, track)
    weighted = dense(system.contact.weighted)
    position = np.concatenate([pairing.carrying.position for pairing in system.contacts.each])
    places = (position @ weighted) / weighted.sum(axis=0)
    on_1 = [(own, places[own]) for own in functions]
    grids = zip(track.ranges, track.each, strict=True)
    on_2 = [(own, grid.position) for own, grid in grids if isinstance(grid, StrokeGrid)]

    def measure(rates_1: np.ndarray, rates_2: np.ndarray) -> float:
        parts = [(rates_1[own], at) for own, at in on_1]
        parts += [(rates_2[own], at) for own, at in on_2]
        return max(_deviation(rate[_within(at)]) for rate, at in parts if rate.any())

    return measure


def _by_closing(stroke: list[Position], track: StrokeGrids) -> Unevenness:
    """Measure by the closing rates at the contact points of each interface in space."""
    systems = {position.offset: position.system for position in stroke}  # one of both directions
    rows = []
    for offset, system in systems.items():
        hats = track.hats(system.contacts)
        parts = zip(track.each, system.contacts, track.strokes, strict=True)
        for index, (grid, (pairing, points), ratio) in enumerate(parts):
            assert isinstance(grid, SweptSurface)
            inner = (
                np.flatnonzero(
                    grid.inner(pairing, ratio * offset * (-1) ** pairing.carrier, _INNER)
                )
                + points.start
            )
            rows.append((index, system.basis[inner], hats[inner]))

    def measure(rates_1: np.ndarray, rates_2: np.ndarray) -> float:
        found = []
        for index in range(len(track.each)):
            own = [(on_1 @ rates_1, on_2 @ rates_2) for k, on_1, on_2 in rows if k == index]
            both = np.hstack(own)
            means = both.mean(axis=1)
            least = means[means > 0.0].min()
            found.append(float(np.abs(both.sum(axis=0) - means.sum()).max() / least))
        return max(found)

    return measure


def _within(place: np.ndarray) -> np.ndarray:
    return np.abs(place - (place[0] + place[-1]) / 2) <= _INNER * (place[-1] - place[0]) / 2


def _deviation(rates: np.ndarray) -> float:
    return float(np.abs(rates / rates.mean() - 1).max())
