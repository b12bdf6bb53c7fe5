"""How body 1 is held: which rigid motions it may make, and what drives each of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...laws.motions import RigidMotion
from ..search.pairing import Pairing


@dataclass(frozen=True)
class RigidMode:
    """A motion of the holder and what is given along it: either of them.

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
class Holder:
    """The rigid holder of body 1.

    Attributes
    ----------
    drives : tuple of RigidMode
        The motions that it makes, k free ones and those that are given.
    closing : ndarray, shape (n, n_drives)
        R of each: how much a unit of it closes the gap at the points.
    carrying : ndarray, shape (n, n_drives)
        T of each: generalised force on it per pressure and area.
    """

    drives: tuple[RigidMode, ...]
    closing: np.ndarray
    carrying: np.ndarray

    @property
    def motions(self) -> tuple[RigidMotion, ...]:
        return tuple(drive.motion for drive in self.drives)

    @property
    def free(self) -> np.ndarray:
        """Which motions are free, under a load, shape (n_drives,)."""
        return np.array([drive.amount is None for drive in self.drives], dtype=bool)

    @property
    def modes(self) -> np.ndarray:
        """R of the free motions, shape (n, k)."""
        return self.closing[:, self.free]

    @property
    def force_modes(self) -> np.ndarray:
        """T of the free motions, shape (n, k)."""
        return self.carrying[:, self.free]

    @property
    def load(self) -> np.ndarray:
        """Of the holder on the free motions, shape (k,) [N or N m]."""
        given = [drive.load for drive in self.drives if drive.load is not None]
        return np.array(given, dtype=float)

    @property
    def dead(self) -> np.ndarray:
        """Constant forces on the free motions beside the holder's, shape (k,) [N or N m]."""
        return np.array([drive.dead for drive in self.drives if drive.load is not None], float)

    @property
    def imposed(self) -> np.ndarray:
        """How far the given motions close the gap, shape (n,) [m]."""
        return self.closing @ self.amounts(np.zeros(int(self.free.sum())))

    def amounts(self, free: np.ndarray) -> np.ndarray:
        """Amounts of all motions from those of the free ones, shape (n_drives,) [m or rad]."""
        result = np.array([drive.amount or 0.0 for drive in self.drives], dtype=float)
        result[self.free] = free
        return result

    def carried(self, pressure: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Generalised force of a pressure on each motion, shape (n_drives,) [N or N m]."""
        return self.carrying.T @ (weights * pressure)


def hold(
    pairing: Pairing, pull: np.ndarray, drives: list[RigidMode] | tuple[RigidMode, ...]
) -> Holder:
    """Make the holder.

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
    return Holder(tuple(drives), closing, carrying)
