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
    amplitude : float or None
        Given motion [m or rad].
    dead : float
        Constant generalised force on body 1 that does not come from the holder [N or N m].
    """

    motion: RigidMotion
    load: float | None = None
    amplitude: float | None = None
    dead: float = 0.0

    def __post_init__(self):
        if (self.load is None) == (self.amplitude is None):
            raise ValueError("holder: give either the load or the motion")


@dataclass(frozen=True)
class RigidHolder:
    """Rigid holder of body 1.

    Attributes
    ----------
    rigid_modes : tuple of RigidMode
        Its rigid modes: k free ones, and those with given motion.
    closure : ndarray, shape (n, n_modes)
        Matrix R: gap closure at the points per unit of each mode.
    force_response : ndarray, shape (n, n_modes)
        Matrix T: generalised force on each mode per pressure and area.
    """

    rigid_modes: tuple[RigidMode, ...]
    closure: np.ndarray
    force_response: np.ndarray

    @property
    def motions(self) -> tuple[RigidMotion, ...]:
        return tuple(mode.motion for mode in self.rigid_modes)

    @property
    def free(self) -> np.ndarray:
        """True for modes under a given load, whose motion is free, shape (n_modes,)."""
        return np.array([mode.amplitude is None for mode in self.rigid_modes], dtype=bool)

    @property
    def modes(self) -> np.ndarray:
        """Columns of R of the free motions, shape (n, k)."""
        return self.closure[:, self.free]

    @property
    def force_modes(self) -> np.ndarray:
        """Columns of T of the free motions, shape (n, k)."""
        return self.force_response[:, self.free]

    @property
    def load(self) -> np.ndarray:
        """Generalised force of the holder on the free motions, shape (k,) [N or N m]."""
        given = [mode.load for mode in self.rigid_modes if mode.load is not None]
        return np.array(given, dtype=float)

    @property
    def dead(self) -> np.ndarray:
        """Constant forces on the free motions that the holder does not exert, (k,) [N or N m]."""
        return np.array([mode.dead for mode in self.rigid_modes if mode.load is not None], float)

    @property
    def imposed(self) -> np.ndarray:
        """Gap closure by the given motions, shape (n,) [m]."""
        return self.closure @ self.amplitudes(np.zeros(int(self.free.sum())))

    def amplitudes(self, free: np.ndarray) -> np.ndarray:
        """Amplitudes of all modes from those of the free ones, shape (n_modes,) [m or rad]."""
        result = np.array([mode.amplitude or 0.0 for mode in self.rigid_modes], dtype=float)
        result[self.free] = free
        return result


def hold(
    pairing: Pairing,
    traction_direction: np.ndarray,
    rigid_modes: list[RigidMode] | tuple[RigidMode, ...],
) -> RigidHolder:
    """Build the holder from its rigid modes.

    Parameters
    ----------
    pairing : Pairing
    traction_direction : ndarray, shape (n, gdim)
        ``n + mu e``, see `pairing`.
    rigid_modes : sequence of RigidMode
    """
    points = pairing.on_body_1
    moved = np.array([mode.motion.at(points) for mode in rigid_modes]).reshape(-1, *points.shape)
    closure = np.einsum("kni,ni->nk", moved, pairing.normals)
    force_response = np.einsum("kni,ni->nk", moved, traction_direction)
    return RigidHolder(tuple(rigid_modes), closure, force_response)
