"""How much heat bodies have, and where the heat so far has gone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...balances import relative
from ...contact.operators.heat import ThermalState
from ...serialise import serialisable


@serialisable
@dataclass(frozen=True)
class StoredHeat:
    """Heat in the bodies, where temperatures are followed in time.

    Attributes
    ----------
    rise : ndarray, shape (n_owned,)
        Of the nodes over the ambient [K].
    content : ndarray, shape (n_owned,)
        Heat that the nodes have stored over the ambient [J].
    turnover : ndarray, shape (3,)
        Heat put in so far by friction and through surfaces, heat lost, and the magnitude of all
        that has come in or gone out [J].
    largest : float
        Rise of the faces so far, either way; of the bodies where not friction alone heats them [K].
    """

    rise: np.ndarray
    content: np.ndarray
    turnover: np.ndarray
    largest: float

    def towards(self, other: StoredHeat, part: float) -> StoredHeat:
        """Moved on by a part of the way to another state."""
        return StoredHeat(
            self.rise + part * (other.rise - self.rise),
            self.content + part * (other.content - self.content),
            self.turnover + part * (other.turnover - self.turnover),
            other.largest,
        )


@dataclass(frozen=True)
class TemperatureField:
    """How warm bodies and faces are.

    Attributes
    ----------
    faces : ThermalState
    rise : ndarray, shape (n_owned,)
        Of the nodes over the ambient [K].
    error : float
        Relative imbalance of heat.
    """

    faces: ThermalState
    rise: np.ndarray
    error: float


@dataclass(frozen=True)
class HeatBalance:
    """Heat from the start on.

    Attributes
    ----------
    made, stored, lost : float
        By friction and through surfaces with a given flux or power, in the bodies, and to their
        surroundings [J].
    moved : float
        Magnitude of all heat that has come in, gone out, or gone from one place to another [J].
    """

    made: float
    stored: float
    lost: float
    moved: float

    @property
    def error(self) -> float:
        """What is missing, relative to the largest of them."""
        scale = max(abs(self.made), abs(self.stored), abs(self.lost), self.moved)
        return relative(self.made - self.stored - self.lost, scale)
