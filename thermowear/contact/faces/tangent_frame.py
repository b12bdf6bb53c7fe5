"""Tangential directions on faces in space: one frame, transported to all normals."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

_LEAST_SUM = 0.2
"""Least ``1 + m·n`` of a pole m and the normals: beyond it the frame turns fast."""
_PARALLEL = 0.9
"""Cosine between the pole and x from which the first axis follows y instead."""


@dataclass(frozen=True)
class TangentFrame:
    """Orthonormal tangential directions e_1, e_2 on a face in space.

    The axes at the pole m, a unit vector, are rotated by the smallest rotation that takes m to the
    normal n (parallel transport along the great circle between them),

        e_i = a_i - (a_i·n) (m + n) / (1 + m·n),

    so that they are smooth over the face and coincide wherever two frames have the same normal.
    Right-handed with respect to the inward normal: ``e_2 = e_1 × n``; for a body above the plane
    z = 0 they are x and y.

    Attributes
    ----------
    pole : ndarray, shape (3,)
        Unit vector m, opposite to no normal.
    turned : float
        Angle by which both axes are turned about the pole, from e_1 towards e_2 [rad].
    """

    pole: np.ndarray
    turned: float = 0.0

    @cached_property
    def axes(self) -> np.ndarray:
        """Axes a_1 and a_2 at the pole, shape (2, 3): along x, or y for a pole along x."""
        along = np.array([0.0, 1.0, 0.0] if abs(self.pole[0]) > _PARALLEL else [1.0, 0.0, 0.0])
        first = along - (along @ self.pole) * self.pole
        first = first / np.linalg.norm(first)
        second, (c, s) = np.cross(first, self.pole), (np.cos(self.turned), np.sin(self.turned))
        return np.array([c * first + s * second, c * second - s * first])

    def at(self, normals: np.ndarray) -> np.ndarray:
        """Directions at points with unit normals (n, 3), shape (2, n, 3)."""
        slopes = self.axes @ normals.T / (1 + normals @ self.pole)
        return self.axes[:, None] - slopes[..., None] * (self.pole + normals)


def frame_in_space(
    normals: np.ndarray, weights: np.ndarray, pole: np.ndarray | None = None, turned: float = 0.0
) -> TangentFrame:
    """Frame of a face from its normals.

    Its pole is a given direction, or the mean normal; or, where the normals turn far away from
    both, the coordinate direction nearest to all of them.

    Parameters
    ----------
    normals : ndarray, shape (n, 3)
    weights : ndarray, shape (n,)
        Areas of the points [m²].
    pole : ndarray, shape (3,), optional
        Preferred pole, such as the load direction.
    turned : float, optional
        See `TangentFrame` [rad].
    """
    mean = weights @ normals
    candidates = [] if pole is None else [pole]
    if np.linalg.norm(mean) > _LEAST_SUM * weights.sum():
        candidates.append(mean / np.linalg.norm(mean))
    for candidate in candidates:
        if 1.0 + (normals @ candidate).min() > _LEAST_SUM:
            return TangentFrame(candidate, turned)
    signed = np.concatenate([np.eye(3), -np.eye(3)])
    return TangentFrame(signed[np.argmax((normals @ signed.T).min(axis=0))], turned)
