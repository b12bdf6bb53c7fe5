"""Tracks of a body that passes the contact, along which its wear is distributed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..laws.distribution import Distribution, rings, round_duty, uniform_track


@dataclass(frozen=True)
class EvenTrack:
    """Track of a section on which wear is uniform.

    Attributes
    ----------
    length : float
        [m]
    name : str
        Name of a track that passes several interfaces, each of which wears all of it.
    """

    length: float
    name: str = ""

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
class TabulatedTrack:
    """Circles of a disk under a face of any outline, each worn evenly.

    Attributes
    ----------
    center : tuple of float
        x and y of the axis of the disk [m].
    radii : tuple of float
        Distances from it, increasing [m].
    duty : tuple of float
        Fractions of a turn for which points of the disk at these distances are in the contact.
    """

    center: tuple[float, float]
    radii: tuple[float, ...]
    duty: tuple[float, ...]

    def distribution(
        self, points: np.ndarray, weights: np.ndarray, thickness: float
    ) -> Distribution:
        """Distribution of the wear; see `FaceWear.distribution`."""
        radii = np.linalg.norm(points[:, :2] - np.array(self.center), axis=1)
        return rings(radii, weights, np.interp(radii, self.radii, self.duty))


@dataclass(frozen=True)
class PinTrack:
    """Circles of a disk under a round pin, each worn evenly.

    Attributes
    ----------
    center : tuple of float
        x and y of the axis of the disk [m].
    distance : float
        Distance of the axis of the pin from it [m].
    radius : float or None
        Radius of the contact face, by default the largest distance of a contact point from the axis
        of the pin: it has no effect if the edge of the face is not in contact [m].
    """

    center: tuple[float, float]
    distance: float
    radius: float | None = None

    def distribution(
        self, points: np.ndarray, weights: np.ndarray, thickness: float
    ) -> Distribution:
        """Distribution of the wear; see `FaceWear.distribution`."""
        arms = points[:, :2] - np.array(self.center)
        radii = np.linalg.norm(arms, axis=1)
        radius = self.radius
        if radius is None:
            axis = self._pin_axis(points, weights)
            radius = float(np.linalg.norm(points[:, :2] - axis, axis=1).max())
        return rings(radii, weights, round_duty(radii, self.distance, radius))

    def _pin_axis(self, points: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """X and y of the axis of the pin, in the direction of the middle of the face [m]."""
        arm = weights @ points[:, :2] / weights.sum() - np.array(self.center)
        return np.array(self.center) + self.distance * arm / np.linalg.norm(arm)


Track = EvenTrack | CircularTrack | TabulatedTrack | PinTrack
"""Tracks of a body that passes the contact."""
