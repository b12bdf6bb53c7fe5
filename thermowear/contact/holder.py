"""How body 1 is held: which way it may move as a rigid body, and what pushes it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .pairing import Pairing


@dataclass(frozen=True)
class Holder:
    """The rigid holder of body 1, which translates along one direction.

    Attributes
    ----------
    direction : ndarray, shape (2,)
        Unit translation along the load.
    closing : ndarray, shape (n,)
        R: how much a unit of it closes the gap at the points.
    carrying : ndarray, shape (n,)
        T: the part of ``n + mu e`` along it, with which the pressure carries the load.
    force : float or None
        Load along the direction [N]; None where the approach is given.
    approach : float or None
        Given translation [m].
    """

    direction: np.ndarray
    closing: np.ndarray
    carrying: np.ndarray
    force: float | None
    approach: float | None

    @property
    def modes(self) -> np.ndarray:
        """R of the free motions, shape (n, k); k is 1 under a force and 0 else."""
        return self.closing[:, None] if self.approach is None else np.zeros((len(self.closing), 0))

    @property
    def force_modes(self) -> np.ndarray:
        """T of the free motions, shape (n, k)."""
        return self.carrying[:, None] if self.approach is None else self.modes

    @property
    def load(self) -> np.ndarray:
        """F along the free motions, shape (k,) [N]."""
        return np.array([] if self.force is None else [self.force])

    @property
    def imposed(self) -> np.ndarray:
        """How far a given approach closes the gap, shape (n,) [m]."""
        return self.closing * (self.approach or 0.0)

    def translation(self, motion: np.ndarray) -> float:
        """How far the holder stands along its direction, given its free motions [m]."""
        return float(motion[0]) if self.approach is None else self.approach

    def carried(self, pressure: np.ndarray, weights: np.ndarray) -> float:
        """Force of a pressure along the direction [N]."""
        return float(weights @ (pressure * self.carrying))


def hold(
    pairing: Pairing,
    pull: np.ndarray,
    direction: tuple[float, float],
    force: float | None,
    approach: float | None,
) -> Holder:
    """Make the holder.

    Parameters
    ----------
    pairing : Pairing
    pull : ndarray, shape (n, 2)
        ``n + mu e``, see `pairing`.
    direction : tuple of float
    force, approach : float or None
        Exactly one of them, see `Holder`.
    """
    m = np.asarray(direction)
    return Holder(m, pairing.normals @ m, pull @ m, force, approach)
