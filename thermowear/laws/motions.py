"""Rigid motions of body 1, admitted by its holder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


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
        dim = points.shape[-1]
        arms = np.zeros((*points.shape[:-1], 3))
        arms[..., :dim] = points
        moved = self.translation + np.cross(self.rotation, arms - self.pivot)
        return moved[..., :dim]


def translation(direction) -> RigidMotion:
    """Unit translation along a direction of two or three components."""
    return RigidMotion(_spatial(direction), np.zeros(3), np.zeros(3))


def rotation(axis, pivot) -> RigidMotion:
    """Unit rotation about an axis (three components) through a point of two or three [m]."""
    return RigidMotion(np.zeros(3), _spatial(axis), _spatial(pivot))


def _spatial(vector) -> np.ndarray:
    result = np.zeros(3)
    result[: len(vector)] = vector
    return result


def combined(motions, amplitudes) -> RigidMotion:
    """Superposition of small motions with given amplitudes; its pivot is the origin."""
    turned = np.zeros(3)
    moved = np.zeros(3)
    for motion, amplitude in zip(motions, amplitudes, strict=True):
        turned = turned + amplitude * motion.rotation
        moved = moved + amplitude * motion.at(np.zeros(3))
    return RigidMotion(moved, turned, np.zeros(3))
