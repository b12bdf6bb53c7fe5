"""Rigid motions of body 1, admitted by its holder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

NOTHING_PRESSED = (
    "nothing is pressed: needs a force, a moment or an approach of a holder, a pressure, heat, or "
    "faces that overlap in the mesh"
)
"""Message on bodies in contact that neither loads nor heat close."""
_ROUNDING = 1e-9


@dataclass(frozen=True)
class RigidMotion:
    """Unit rigid motion: a translation, or a rotation about an axis.

    Attributes
    ----------
    translation : ndarray, shape (3,)
    rotation : ndarray, shape (3,)
        Axis by the right-hand rule; plane models turn about the third direction.
    pivot : ndarray, shape (3,)
        A point of the axis [m].
    """

    translation: np.ndarray
    rotation: np.ndarray
    pivot: np.ndarray

    @property
    def reversed(self) -> RigidMotion:
        """Opposite motion."""
        return RigidMotion(-self.translation, -self.rotation, self.pivot)

    def at(self, points: np.ndarray) -> np.ndarray:
        """Displacement of points per unit of the motion.

        Parameters
        ----------
        points : ndarray, shape (..., 2) or (..., 3) [m]

        Returns
        -------
        ndarray, of the points' shape
            Unit translation, or [m] for a rotation by 1 rad.
        """
        moved = self.translation + np.cross(self.rotation, spatial(points) - self.pivot)
        return moved[..., : points.shape[-1]]


@dataclass(frozen=True)
class TurningAxis:
    """Axis in space that a body turns about in place, as a ball in its socket.

    Attributes
    ----------
    point : tuple of float
        A point of it [m].
    direction : tuple of float
        Unit vector; the sense of rotation follows by the right-hand rule.
    """

    point: tuple[float, float, float]
    direction: tuple[float, float, float]

    def velocity(self, points: np.ndarray, angular_velocity: float) -> np.ndarray:
        """Velocity of points that turn about it, shape (n, 3) [m/s]."""
        return angular_velocity * rotation(self.direction, self.point).at(points)


def axis_of(point, direction) -> TurningAxis:
    """Axis through a point (three components) [m] along a vector of any length.

    Raises
    ------
    ValueError
        If the vector has no direction.
    """
    length = float(np.linalg.norm(direction))
    if not 0.0 < length < np.inf:
        raise ValueError("the vector has no direction")
    (px, py, pz), (x, y, z) = map(float, point), (float(d) / length for d in direction)
    return TurningAxis((px, py, pz), (x, y, z))


def translation(direction) -> RigidMotion:
    """Unit translation along a direction of two or three components."""
    return RigidMotion(spatial(direction), np.zeros(3), np.zeros(3))


def rotation(axis, pivot) -> RigidMotion:
    """Unit rotation about an axis (three components) through a point of two or three [m]."""
    return RigidMotion(np.zeros(3), spatial(axis), spatial(pivot))


def spatial(vectors) -> np.ndarray:
    """Vectors of two or three components (last axis) with three of them."""
    given = np.asarray(vectors, dtype=float)
    result = np.zeros((*given.shape[:-1], 3))
    result[..., : given.shape[-1]] = given
    return result


def combined(motions, amplitudes) -> RigidMotion:
    """Superposition of small motions with given amplitudes; its pivot is the origin."""
    origin = np.zeros(3)
    pairs = list(zip(motions, amplitudes, strict=True))
    moved = sum((amplitude * motion.at(origin) for motion, amplitude in pairs), origin)
    turned = sum((amplitude * motion.rotation for motion, amplitude in pairs), origin)
    return RigidMotion(moved, turned, origin)


def spans(
    directions: Sequence[Sequence[float] | np.ndarray], vector: Sequence[float] | np.ndarray
) -> bool:
    """True if a vector is a combination of directions, up to rounding."""
    given = np.asarray(vector, dtype=float)
    if not directions:
        return not given.any()
    basis = np.array(directions, dtype=float).T
    rest = given - basis @ np.linalg.lstsq(basis, given, rcond=None)[0]
    return bool(np.linalg.norm(rest) <= _ROUNDING * np.linalg.norm(given))
