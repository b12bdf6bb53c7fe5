"""Stored heat, temperature fields and heat balance of the bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...balances import relative
from ...contact.operators.heat import ThermalState
from ...serialise import serialisable


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
        """Interpolate linearly (or extrapolate) to another state by a fraction of the way."""
        return StoredHeat(
            self.rise + part * (other.rise - self.rise),
            self.content + part * (other.content - self.content),
            self.turnover + part * (other.turnover - self.turnover),
            other.largest,
        )


@dataclass(frozen=True)
class TemperatureField:
    """Temperatures of bodies and faces.

    Attributes
    ----------
    faces : ThermalState
    rise : ndarray, shape (n_owned,)
        Nodal temperature rise over the ambient [K].
    error : float
        Relative error of the heat balance.
    """

    faces: ThermalState
    rise: np.ndarray
    error: float


@dataclass(frozen=True)
class HeatBalance:
    """Heat balance since the start.

    Attributes
    ----------
    made, stored, lost : float
        Heat input by friction and through surfaces with a given flux or power, heat stored in the
        bodies, and heat lost to the surroundings [J].
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
        return relative(self.made - self.stored - self.lost, scale)
