"""Coulomb friction at points: projection of trial tractions, and its derivative."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class PointTractions:
    """Pressure and shear at the points; c = 1 + t components.

    Attributes
    ----------
    values : ndarray, shape (c, n) [Pa]
    slopes : ndarray, shape (c, c, n)
        Derivatives by the trial tractions of the same point.
    sticking : ndarray of bool, shape (n,)
        False also at open points.
    """

    values: np.ndarray
    slopes: np.ndarray
    sticking: np.ndarray


def projected(trial: np.ndarray, friction: np.ndarray, softening: np.ndarray) -> PointTractions:
    """Pressures without tension, and shears projected on the disc of radius ``mu p``.

    Parameters
    ----------
    trial : ndarray, shape (c, n) [Pa]
    friction : ndarray, shape (n,)
    softening : ndarray, shape (n,)
        Pressure per positive trial pressure.
    """
    normal, tangential = softening * trial[0], trial[1:]
    closed = normal > 0.0
    pressure = np.maximum(normal, 0.0)
    radius, length = friction * pressure, np.linalg.norm(tangential, axis=0)
    sticking = closed & (length <= radius)
    direction = tangential / np.where(length > 0.0, length, 1.0)
    shear = np.where(sticking, tangential, radius * direction)
    slips = closed & ~sticking
    slopes = assumed_slopes(closed, sticking, friction * direction, softening)
    turning = slips * radius / np.where(length > 0.0, length, 1.0)
    across = np.eye(len(tangential))[..., None] - direction[:, None] * direction
    slopes[1:, 1:] += turning * across
    return PointTractions(np.vstack([pressure, shear]), slopes, sticking)


def assumed_slopes(
    closed: np.ndarray, sticking: np.ndarray, drag: np.ndarray, softening: np.ndarray
) -> np.ndarray:
    """Derivatives, shape (c, c, n), at points that stick or slip in a fixed direction.

    Parameters
    ----------
    closed, sticking : ndarray of bool, shape (n,)
        Closed points, and those of them that stick.
    drag : ndarray, shape (t, n)
        Shear per pressure of the others.
    softening : ndarray, shape (n,)
    """
    t, n = drag.shape
    slopes = np.zeros((1 + t, 1 + t, n))
    slopes[0, 0] = closed * softening
    slopes[1:, 0] = (closed & ~sticking) * softening * drag
    slopes[np.arange(1, 1 + t), np.arange(1, 1 + t)] = sticking
    return slopes
