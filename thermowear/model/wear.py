"""Wear of one face of an interface: law, factors, and the track that passes the contact."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..laws.coefficients import Multipliers
from ..laws.distribution import Distribution, InPlace, rings, uniform_track
from ..laws.interfaces import Law


@dataclass(frozen=True)
class EvenTrack:
    """Track of a section on which wear is uniform.

    Attributes
    ----------
    length : float
        [m]
    """

    length: float

    def distribution(
        self, points: np.ndarray, weights: np.ndarray, thickness: float
    ) -> Distribution:
        """Distribution of the wear; see `FaceWear.distribution`."""
        return uniform_track(weights / thickness / self.length)


@dataclass(frozen=True)
class CircularTrack:
    """Circles of a disk about a vertical axis, each worn evenly.

    Attributes
    ----------
    center : tuple of float
        x and y of the axis [m].
    duty : float
        Fraction of a turn for which a point of the disk is in the contact.
    """

    center: tuple[float, float]
    duty: float

    def distribution(
        self, points: np.ndarray, weights: np.ndarray, thickness: float
    ) -> Distribution:
        """Distribution of the wear; see `FaceWear.distribution`."""
        arms = points[:, :2] - np.array(self.center)
        return rings(np.linalg.norm(arms, axis=1), weights, self.duty)


@dataclass(frozen=True)
class FaceWear:
    """Wear of one face.

    Attributes
    ----------
    law : Law
    factors : Multipliers
        Tabulated factors of the rate, by the temperature of the face, the pressure and the speed.
    friction_exponent : float
        Exponent of the coefficient of friction in a law per friction stress; 0 in other laws.
    track : Distribution, EvenTrack or CircularTrack
        In place, at a constant duty factor, or along a track that passes the contact.
    per : str or None
        Stress that a coefficient of wear multiplies, for the summary; None for other laws.
    """

    law: Law
    factors: Multipliers = field(default_factory=Multipliers)
    friction_exponent: float = 0.0
    track: Distribution | EvenTrack | CircularTrack = field(default_factory=InPlace)
    per: str | None = None

    @property
    def in_place(self) -> bool:
        """True if the face wears where it is pressed."""
        return isinstance(self.track, InPlace)

    def distribution(
        self, points: np.ndarray, weights: np.ndarray, thickness: float
    ) -> Distribution:
        """Distribution of the wear at contact points.

        Parameters
        ----------
        points : ndarray, shape (n, gdim) [m]
        weights : ndarray, shape (n,) [m²]
        thickness : float
            Thickness of a plane model; 1 in the others [m].
        """
        if isinstance(self.track, Distribution):
            return self.track
        return self.track.distribution(points, weights, thickness)

    @property
    def varies(self) -> bool:
        """True if the rate depends on temperature or depth, or has tabulated factors."""
        return bool(self.law.variables & {"T", "depth"} or self.factors.variables)
