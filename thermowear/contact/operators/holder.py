"""Holder of body 1: its rigid modes, and the load or motion along each of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...laws.motions import RigidMotion
from ..search.pairing import Pairing


@dataclass(frozen=True)
class RigidMode:
    """Rigid motion of the holder with a given load or a given amplitude.

    Attributes
    ----------
    motion : RigidMotion
    load : float or None
        Generalised force: force along a translation [N], moment of a rotation [N m].
    amount : float or None
        Given motion [m or rad].
    dead : float
        Constant generalised force on body 1 that does not come from the holder [N or N m].
    """

    motion: RigidMotion
    load: float | None = None
    amount: float | None = None
    dead: float = 0.0

    def __post_init__(self):
        if (self.load is None) == (self.amount is None):
            raise ValueError("holder: give either the load or the motion")


@dataclass(frozen=True)
class RigidHolder:
    """Rigid holder of body 1.

    Attributes
    ----------
    drives : tuple of RigidMode
        Its rigid modes: k free ones, and those with given motion.
    closing : ndarray, shape (n, n_drives)
        Matrix R: gap closure at the points per unit of each mode.
    carrying : ndarray, shape (n, n_drives)
        Matrix T: generalised force on each mode per pressure and area.
    """

    drives: tuple[RigidMode, ...]
    closing: np.ndarray
    carrying: np.ndarray

    @property
    def motions(self) -> tuple[RigidMotion, ...]:
        return tuple(drive.motion for drive in self.drives)

    @property
    def free(self) -> np.ndarray:
        """True for modes under a given load, whose motion is free, shape (n_drives,)."""
        return np.array([drive.amount is None for drive in self.drives], dtype=bool)

    @property
    def modes(self) -> np.ndarray:
        """Columns of R of the free motions, shape (n, k)."""
        return self.closing[:, self.free]

    @property
    def force_modes(self) -> np.ndarray:
        """Columns of T of the free motions, shape (n, k)."""
        return self.carrying[:, self.free]

    @property
    def load(self) -> np.ndarray:
        """Generalised force of the holder on the free motions, shape (k,) [N or N m]."""
        given = [drive.load for drive in self.drives if drive.load is not None]
        return np.array(given, dtype=float)

    @property
    def dead(self) -> np.ndarray:
        """Constant forces on the free motions that the holder does not exert, (k,) [N or N m]."""
        return np.array([drive.dead for drive in self.drives if drive.load is not None], float)

    @property
    def imposed(self) -> np.ndarray:
        """Gap closure by the given motions, shape (n,) [m]."""
        return self.closing @ self.amounts(np.zeros(int(self.free.sum())))

    def amounts(self, free: np.ndarray) -> np.ndarray:
        """Amplitudes of all modes from those of the free ones, shape (n_drives,) [m or rad]."""
        result = np.array([drive.amount or 0.0 for drive in self.drives], dtype=float)
        result[self.free] = free
        return result

    def carried(self, pressure: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Generalised force of a pressure on each motion, shape (n_drives,) [N or N m]."""
        return self.carrying.T @ (weights * pressure)


def hold(
    pairing: Pairing, pull: np.ndarray, drives: list[RigidMode] | tuple[RigidMode, ...]
) -> RigidHolder:
    """Build the holder from its rigid modes.

    Parameters
    ----------
    pairing : Pairing
    pull : ndarray, shape (n, gdim)
        ``n + mu e``, see `pairing`.
    drives : sequence of RigidMode
    """
    points = pairing.on_body_1
    moved = np.array([drive.motion.at(points) for drive in drives]).reshape(-1, *points.shape)
    closing = np.einsum("kni,ni->nk", moved, pairing.normals)
    carrying = np.einsum("kni,ni->nk", moved, pull)
    return RigidHolder(tuple(drives), closing, carrying)
