"""Wear-rate vectors: normal and tangential motion of the worn surface.

In the steady state the wear-rate vector of either body is collinear with the rigid-body wear
velocity of body 1, ``w'_i = w'_Ri e_R`` with ``w'_Ri = w'_ni / cos χ`` (Páczelt and Mróz, Int. J.
Solids Struct. 44 (2007) 895). Its tangential part ``w'_ni tan χ`` is the motion of the worn shape
along the face.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .patch import ContactPatch
from .steady import SteadyWear


@dataclass(frozen=True)
class WearVectors:
    """Wear-rate vectors at the contact points.

    Attributes
    ----------
    rigid : ndarray, shape (n, 3)
        Rigid-body wear velocity [m/s].
    direction : ndarray, shape (n, 3)
        Unit vector ``e_R`` of it.
    inclination : ndarray, shape (n,)
        χ, the angle between the normal and ``e_R`` [rad]; above π/2 the faces separate.
    rates : tuple of ndarray, shape (n, 3)
        Wear-rate vector of each wearing body [m/s]; along the normal where the faces separate.
    tangential : tuple of ndarray, shape (n, 3)
        Tangential components of the wear-rate vectors [m/s].
    """

    rigid: np.ndarray
    direction: np.ndarray
    inclination: np.ndarray
    rates: tuple[np.ndarray, ...]
    tangential: tuple[np.ndarray, ...]


def wear_vectors(patch: ContactPatch, steady: SteadyWear) -> WearVectors:
    """Compute the wear-rate vectors of a steady state."""
    rigid = patch.velocity(steady.velocity)
    length = np.linalg.norm(rigid, axis=1)
    direction = rigid / np.where(length > 0, length, 1.0)[:, None]
    cosine = np.sum(direction * patch.normals, axis=1)
    along = patch.normals.copy()  # e_R / cos χ, of normal component 1
    approaching = cosine > 0
    along[approaching] = direction[approaching] / cosine[approaching, None]
    vectors = tuple(rate[:, None] * along for rate in steady.rates)
    flat = tuple(
        vector - rate[:, None] * patch.normals
        for vector, rate in zip(vectors, steady.rates, strict=True)
    )
    return WearVectors(rigid, direction, np.arccos(np.clip(cosine, -1.0, 1.0)), vectors, flat)
