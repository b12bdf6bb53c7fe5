"""What is known of meshes that have been moved to their worn faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from ..contact.pairing import Pairing

_SAME = 1e-9


@dataclass(frozen=True)
class WornGeometry:
    """Meshes moved to the worn faces, and the depths that are in them and no more in the gap.

    Attributes
    ----------
    points : ndarray, shape (n_points, 2)
        Nodes of the mesh, in the order of that of the unworn bodies [m].
    directions : tuple of ndarray, shape (n_nodes, 2)
        Ways of the nodes of both faces, see `contact.worn_face.Paths`.
    held : tuple of ndarray of bool, shape (n_nodes,)
        Likewise.
    at : ndarray, shape (n_before,)
        Facet plus parameter, on the face of body 1, of the contact points before the last update.
    depth : ndarray, shape (2, n_before)
        Depth off each body that the mesh has lost, at these points [m].
    lacking : ndarray, shape (n_before,)
        Depth that the initial shape lacks of the unworn face [m].
    holder : tuple of ndarray, shape (3,)
        Translation and rotation of body 1 when the faces were paired anew [m, rad].
    lost : ndarray, shape (2,)
        Volume that each mesh has lost [m³].
    updates : int
        How often the mesh was moved.
    quality : float
        Smallest scaled Jacobian of its cells so far.
    volume_error : float
        Largest difference so far of what a mesh has lost in an update and the volume worn off,
        relative to it.
    change : float
        Largest change so far of pressure and temperatures by an update, relative to their means.
    heat_error : float
        Largest error so far of temperatures carried over, relative to the largest rise.
    """

    points: np.ndarray
    directions: tuple[np.ndarray, np.ndarray]
    held: tuple[np.ndarray, np.ndarray]
    at: np.ndarray
    depth: np.ndarray
    lacking: np.ndarray
    holder: tuple[np.ndarray, np.ndarray]
    lost: np.ndarray
    updates: int
    quality: float
    volume_error: float
    change: float = 0.0
    heat_error: float = 0.0

    def carried(self, values: np.ndarray, pairing: Pairing) -> np.ndarray:
        """Values (..., n_before) at the points of a new pairing of the same faces."""
        return carried(values, self.at, along(pairing))


def along(pairing: Pairing) -> np.ndarray:
    """Facet plus parameter of the contact points on the face of body 1, shape (n,)."""
    return pairing.sides[0].facet + pairing.sides[0].t


def carried(values: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Values (..., n) at other places along a face."""
    if before.shape == after.shape and np.abs(before - after).max() < _SAME:
        return values
    curve = Akima1DInterpolator(before, values, axis=-1, method="makima")
    return curve(np.clip(after, before[0], before[-1]))
