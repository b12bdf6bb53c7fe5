"""Heat stored in the bodies in transient conduction, and its balance since the start."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...parallel import sum_over_ranks
from ...serialise import serialisable

_ROUNDING = 1e-3
"""Least scale of the heat balance, relative to the initial heat content (rounding)."""


@dataclass(frozen=True)
class HeatBalance:
    """Heat balance since the start.

    Attributes
    ----------
    made, stored, lost : float
        Heat by friction and surfaces with given flux or power, in the bodies, and lost [J].
    moved : float
        Magnitude of all heat put in, lost, or moved inside the bodies [J].
    """

    made: float
    stored: float
    lost: float
    moved: float

    @property
    def error(self) -> float:
        """Imbalance relative to the largest term."""
        scale = max(abs(self.made), abs(self.stored), abs(self.lost), self.moved)
        return abs(self.made - self.stored - self.lost) / (scale or 1.0)


@serialisable
@dataclass(frozen=True)
class StoredHeat:
    """Heat stored in the bodies in transient conduction.

    Attributes
    ----------
    rise : ndarray, shape (n_owned,)
        Nodal temperature rise over the ambient [K].
    content : ndarray, shape (n_owned,)
        Nodal heat content over the ambient [J].
    turnover : ndarray, shape (3,)
        Cumulated heat input by friction and through surfaces, heat lost, and sum of the magnitudes
        of all heat in and out [J].
    largest : float
        Largest magnitude so far of the rise of the faces; also inside the bodies where friction is
        not the only heat source [K].
    """

    rise: np.ndarray
    content: np.ndarray
    turnover: np.ndarray
    largest: float

    def towards(self, other: StoredHeat, part: float) -> StoredHeat:
        """Interpolate linearly (or extrapolate) to another state by a fraction of the distance."""
        return StoredHeat(
            self.rise + part * (other.rise - self.rise),
            self.content + part * (other.content - self.content),
            self.turnover + part * (other.turnover - self.turnover),
            other.largest,
        )

    def balance(self, initial: StoredHeat, comm) -> HeatBalance:
        """Heat balance since an initial state on the same mesh; every rank calls."""
        gained, before = self.content - initial.content, np.abs(initial.content).sum()
        sums = np.array([gained.sum(), np.abs(gained).sum(), before])
        gain, shifted, had = (float(heat) for heat in sum_over_ranks(comm, sums))
        made, lost, exchanged = (float(heat) for heat in self.turnover)
        return HeatBalance(made, gain, lost, max(exchanged, shifted, _ROUNDING * had))
