"""Worn profile of a body on which the carrying one reciprocates; in space see `swept_surface`.

The depth is piecewise linear on a separate grid along the face, as the contact points differ in
every position. A position represents a segment of the stroke: the depth at a point is the mean over
the segment. Worn depth is distributed to the nodes with the same weights, which conserves volume.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy
import scipy.sparse as sp

from ..search.contacts import Contacts
from ..search.pairing import Pairing
from .swept_surface import STEPS, SweptSurface


@dataclass(frozen=True)
class StrokeGrid:
    """Grid of the worn profile along the face that does not carry the contact points.

    Attributes
    ----------
    position : ndarray, shape (n_nodes,)
        Arc length along the face [m].
    areas : ndarray, shape (n_nodes,)
        Area of each node [m²].
    """

    position: np.ndarray
    areas: np.ndarray

    def hats(self, pairing: Pairing, length: float = 0.0) -> np.ndarray:
        """Values of the hat functions at the contact points of a pairing, (n, n_nodes).

        Parameters
        ----------
        pairing : Pairing
        length : float
            Length of the segment, centred at the points, over which means are taken [m].
        """
        places = pairing.opposite.position
        if length == 0.0:
            return hat_functions(self.position, places)
        steps = length * ((np.arange(STEPS) + 0.5) / STEPS - 0.5)
        return np.mean([hat_functions(self.position, places + step) for step in steps], axis=0)


def hat_functions(knots: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Hat functions of increasing knots at places, constant beyond the ends, (n, n_knots)."""
    padded = np.concatenate([knots[:1], knots, knots[-1:]])
    return scipy.interpolate.BSpline.design_matrix(
        np.clip(places, knots[0], knots[-1]), padded, 1
    ).toarray()


@dataclass(frozen=True)
class StrokeGrids:
    """Grids of the worn profiles of the swept bodies of all interfaces, one after the other.

    Attributes
    ----------
    each : tuple of StrokeGrid or SweptSurface
    strokes : tuple of float
        Amplitude at each interface relative to that given.
    """

    each: tuple[StrokeGrid | SweptSurface, ...]
    strokes: tuple[float, ...]

    @cached_property
    def areas(self) -> np.ndarray:
        """Areas of the nodes of all grids [m²]."""
        return np.concatenate([grid.areas for grid in self.each])

    @cached_property
    def ranges(self) -> tuple[slice, ...]:
        """Range of the nodes of each grid."""
        ends = np.cumsum([0, *(len(grid.areas) for grid in self.each)])
        return tuple(slice(int(a), int(b)) for a, b in pairwise(ends))

    def hats(self, contacts: Contacts, length: float = 0.0) -> sp.csr_array:
        """Values of the hat functions at all contact points, shape (n, n_nodes).

        Parameters
        ----------
        contacts : Contacts
        length : float
            Length of the segment of the given stroke, see `StrokeGrid.hats` [m].
        """
        parts = zip(self.each, contacts.each, self.strokes, strict=True)
        values = [sp.csr_array(grid.hats(p, abs(s) * length)) for grid, p, s in parts]
        return sp.block_diag(values, format="csr")


def track(
    pairings: Sequence[Pairing], lengths: Sequence[float], spacing: float, thickness: float
) -> StrokeGrid:
    """Build a uniform grid on the swept part of the face.

    Parameters
    ----------
    pairings : sequence of Pairing
        Contact points in all positions.
    lengths : sequence of float
        Lengths of the segments of the stroke that they represent [m].
    spacing : float
        Largest cell size [m].
    thickness : float
        Thickness of the bodies [m].
    """
    placed = [
        (p.opposite.position, length / 2) for p, length in zip(pairings, lengths, strict=True)
    ]
    first = min(s.min() - half for s, half in placed)
    last = max(s.max() + half for s, half in placed)
    cells = max(1, int(np.ceil((last - first) / spacing - 1e-9)))
    areas = np.full(cells + 1, thickness * (last - first) / cells)
    areas[[0, -1]] /= 2
    return StrokeGrid(np.linspace(first, last, cells + 1), areas)
