"""Speed and direction of sliding of body 1 over body 2 at the contact points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_ZERO_LENGTH = 1e-9
"""Relative length, by the largest vector, below which a vector is rounding noise."""


@dataclass(frozen=True)
class Sliding:
    """Sliding at the contact points; sign convention of `pairing`.

    Attributes
    ----------
    speed : ndarray, shape (n,) [m/s]
    along : ndarray, shape (n, gdim)
        Unit sliding direction e of body 1, components in the section.
    across : ndarray, shape (n, gdim)
        Unit tangent e_2 across the sliding, along which the load pushes body 1 down the face; zero
        where the face is level in that direction.
    """

    speed: np.ndarray
    along: np.ndarray
    across: np.ndarray

    def traction_direction(
        self, normals: np.ndarray, friction: float | np.ndarray, transverse: float
    ) -> np.ndarray:
        """Direction ``n + mu e + mu_d e_2``; the traction on body 1 is minus the pressure times it.

        The transverse part comes from the small velocity of wear across the sliding (Páczelt and
        Mróz, Int. J. Solids Struct. 44 (2007) 895).

        Parameters
        ----------
        normals : ndarray, shape (n, gdim)
        friction : float or ndarray, shape (n, 1)
            Coefficient of friction mu.
        transverse : float
            Transverse coefficient mu_d.

        Returns
        -------
        ndarray, shape (n, gdim)
        """
        return normals + friction * self.along + transverse * self.across


def sliding(
    velocity: np.ndarray, normals: np.ndarray, load_direction: tuple[float, ...]
) -> Sliding:
    """Split the sliding velocity into speed and directions.

    Parameters
    ----------
    velocity : ndarray, shape (n, 3)
        Velocity of body 1 relative to body 2 [m/s], see `bulk.kinematics`.
    normals : ndarray, shape (n, gdim)
        Outward unit normals of body 1.
    load_direction : tuple of float
        Unit vector of the load direction of body 1.
    """
    gdim = normals.shape[1]
    n = _spatial(normals)
    speed = np.linalg.norm(velocity, axis=1)
    along = _unit(_tangential(velocity, n), float(speed.max(initial=0.0)))
    down = _tangential(np.broadcast_to(_spatial(np.array([load_direction])), n.shape), n)
    down = down - np.einsum("ni,ni->n", down, along)[:, None] * along
    return Sliding(speed, along[:, :gdim], _unit(down, 1.0)[:, :gdim])


def _spatial(vectors: np.ndarray) -> np.ndarray:
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def _tangential(vectors: np.ndarray, normals: np.ndarray) -> np.ndarray:
    return vectors - np.einsum("ni,ni->n", vectors, normals)[:, None] * normals


def _unit(vectors: np.ndarray, largest: float) -> np.ndarray:
    """Unit vectors; zero for those negligible against the largest one."""
    sizes = np.linalg.norm(vectors, axis=1, keepdims=True)
    counts = sizes > _ZERO_LENGTH * largest
    return np.divide(vectors, sizes, out=np.zeros_like(vectors), where=counts)
