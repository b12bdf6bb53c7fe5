"""The worn profile of a body along which the other one slides to and fro.

Its depth is piecewise linear on a grid of its own along the face, as the contact points come to lie
elsewhere in every position. A position stands for a part of the stroke: the points see the mean of
the depths that they pass over. What they wear off is spread over the nodes with the same weights,
so that no volume is lost on the way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..search.pairing import Pairing

_STEPS = 16  # along which a mean over a part of the stroke is taken


@dataclass(frozen=True)
class StrokeGrid:
    """A grid along the face of body 2.

    Attributes
    ----------
    position : ndarray, shape (n_nodes,)
        Lengths along the face [m].
    areas : ndarray, shape (n_nodes,)
        Area each node stands for [m²].
    """

    position: np.ndarray
    areas: np.ndarray

    def hats(self, pairing: Pairing, length: float = 0.0) -> np.ndarray:
        """Values of the nodes' functions at the contact points of a pairing, (n, n_nodes).

        Parameters
        ----------
        pairing : Pairing
        length : float
            Of the way along which the points move, half of it to each side: means over it [m].
        """
        if length == 0.0:
            return self._hats(on_body_2(pairing))
        steps = length * ((np.arange(_STEPS) + 0.5) / _STEPS - 0.5)
        return np.mean([self._hats(on_body_2(pairing) + step) for step in steps], axis=0)

    def _hats(self, s: np.ndarray) -> np.ndarray:
        cells = len(self.position) - 1
        cell = np.clip(np.searchsorted(self.position, s, side="right") - 1, 0, cells - 1)
        start, end = self.position[cell], self.position[cell + 1]
        part = np.clip((s - start) / (end - start), 0.0, 1.0)
        values = np.zeros((len(s), cells + 1))
        rows = np.arange(len(s))
        values[rows, cell], values[rows, cell + 1] = 1 - part, part
        return values


def track(
    pairings: Sequence[Pairing], lengths: Sequence[float], spacing: float, thickness: float
) -> StrokeGrid:
    """A grid of equal cells along all of the face that is touched.

    Parameters
    ----------
    pairings : sequence of Pairing
        In all positions.
    lengths : sequence of float
        Of the parts of the stroke that they stand for [m].
    spacing : float
        Size of the cells at most [m].
    thickness : float
        Of the bodies [m].
    """
    placed = [(on_body_2(p), length / 2) for p, length in zip(pairings, lengths, strict=True)]
    first = min(s.min() - half for s, half in placed)
    last = max(s.max() + half for s, half in placed)
    cells = max(1, int(np.ceil((last - first) / spacing - 1e-9)))
    areas = np.full(cells + 1, thickness * (last - first) / cells)
    areas[[0, -1]] /= 2
    return StrokeGrid(np.linspace(first, last, cells + 1), areas)


def on_body_2(pairing: Pairing) -> np.ndarray:
    """Lengths along the face of body 2 at the contact points, shape (n,) [m]."""
    side = pairing.sides[1]
    return side.face.position(side.facet, side.t)
