"""Contact patch: three-dimensional data of a face for the principle, and its wear-rate vectors.

Sign convention of `thermowear.contact.search.pairing`: ``n`` is the outward normal of body 1, and
its traction is ``-p ñ`` with ``ñ = n + mu e_1 + mu_d e_2``. ``e_1`` is the sliding direction of
body 1 over body 2; ``e_2``, across it, is the direction of the tangential rigid-body wear velocity
of body 1, which ``mu_d`` resists.

In the steady state the wear-rate vector of either body is collinear with the rigid-body wear
velocity of body 1, ``w'_i = w'_Ri e_R`` with ``w'_Ri = w'_ni / cos χ`` (Páczelt and Mróz, Int. J.
Solids Struct. 44 (2007) 895). Its tangential part ``w'_ni tan χ`` is the motion of the worn shape
along the face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..distribution import Distribution
from ..motions import RigidMotion, spatial
from ..wear import PowerWear
from .steady import SteadyWear, steady_pressure


@dataclass(frozen=True)
class ContactPatch:
    """Contact points with their directions, and the free motions of the holder of body 1.

    Attributes
    ----------
    points : ndarray, shape (n, 3) [m]
    weights : ndarray, shape (n,)
        Areas [m²]; a point without area is a probe.
    normals : ndarray, shape (n, 3)
        Outward unit normals of body 1.
    traction : ndarray, shape (n, 3)
        Traction direction ``ñ``.
    speed : ndarray, shape (n,)
        Sliding speed [m/s].
    motions : tuple of RigidMotion
    """

    points: np.ndarray
    weights: np.ndarray
    normals: np.ndarray
    traction: np.ndarray
    speed: np.ndarray
    motions: tuple[RigidMotion, ...]

    @property
    def normal_modes(self) -> np.ndarray:
        """Normal modes ``R = m·n`` of the motions, shape (n, k)."""
        return self._along(self.normals)

    @property
    def force_modes(self) -> np.ndarray:
        """Force modes ``T = m·ñ`` of the motions, shape (n, k)."""
        return self._along(self.traction)

    def _along(self, directions: np.ndarray) -> np.ndarray:
        moved = [np.sum(m.at(self.points) * directions, axis=1) for m in self.motions]
        return np.column_stack(moved)

    def part(self, points: np.ndarray) -> ContactPatch:
        """Patch of selected points, by indices or a mask."""
        return replace(
            self,
            points=self.points[points],
            weights=self.weights[points],
            normals=self.normals[points],
            traction=self.traction[points],
            speed=self.speed[points],
        )

    def velocity(self, amplitudes: np.ndarray) -> np.ndarray:
        """Rigid-body velocity of the points at given rates of the motions, shape (n, 3) [m/s]."""
        return np.einsum("k,kni->ni", amplitudes, [m.at(self.points) for m in self.motions])

    def force(self, pressure: np.ndarray) -> np.ndarray:
        """Force ``∫ p ñ dS`` of the holder on body 1, shape (3,) [N]."""
        return (self.weights * pressure) @ self.traction

    def moment(self, pressure: np.ndarray, pivot) -> np.ndarray:
        """Moment of the holder on body 1 about a point, shape (3,) [N m]."""
        arms = self.points - np.asarray(pivot)
        return (self.weights * pressure) @ np.cross(arms, self.traction)

    def steady(
        self, load, laws: Sequence[PowerWear], spread: Sequence[Distribution] | None = None
    ) -> SteadyWear:
        """Steady state under a load along each motion; see `steady_pressure`."""
        return steady_pressure(
            self.weights,
            self.normal_modes,
            self.force_modes,
            np.asarray(load, dtype=float),
            laws,
            self.speed,
            spread,
        )


def contact_patch(
    points,
    weights,
    normals,
    motions: Sequence[RigidMotion],
    speed,
    friction: float = 0.0,
    sliding=(0.0, 0.0, 0.0),
    transverse_friction: float = 0.0,
    transverse=(0.0, 0.0, 0.0),
) -> ContactPatch:
    """Build a patch; values equal at all points may be given once.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3) [m]
        Points of a plane or a spatial model.
    weights : array_like, shape (n,) [m²]
    normals : array_like, shape (2,), (3,), (n, 2) or (n, 3)
        Outward normals of body 1, of any length.
    motions : sequence of RigidMotion
        Free motions of the holder.
    speed : float or array_like, shape (n,) [m/s]
    friction, transverse_friction : float
        mu and mu_d.
    sliding, transverse : array_like
        Unit vectors ``e_1`` and ``e_2``, shaped like the normals; needed if friction along them has
        a component in the section.
    """
    n = len(weights)
    normal = spatial(normals) / np.linalg.norm(normals, axis=-1, keepdims=True)
    shear = friction * spatial(sliding) + transverse_friction * spatial(transverse)
    return ContactPatch(
        points=spatial(points),
        weights=np.asarray(weights, dtype=float),
        normals=np.broadcast_to(normal, (n, 3)),
        traction=np.broadcast_to(normal + shear, (n, 3)),
        speed=np.broadcast_to(np.asarray(speed, dtype=float), n),
        motions=tuple(motions),
    )


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
