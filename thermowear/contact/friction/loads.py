"""Loads on the holder of body 1 in a load history."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Loads:
    """Force or translation along each motion of the holder of body 1 at one instant.

    Attributes
    ----------
    normal_force, tangential_force : float or None
        Forces of the holder on body 1 along its motions [N].
    approach, tangential_displacement : float or None
        Translations of the holder [m]. Exactly one of force and translation is given along each
        motion; neither in the tangential direction if the holder only moves in the normal one.
    """

    normal_force: float | None = None
    approach: float | None = None
    tangential_force: float | None = None
    tangential_displacement: float | None = None

    @property
    def forces(self) -> np.ndarray:
        """Force along each motion, NaN if the translation is given, shape (k,) [N]."""
        return self._pairs[:, 0]

    @property
    def motions(self) -> np.ndarray:
        """Translation along each motion, NaN if the force is given, shape (k,) [m]."""
        return self._pairs[:, 1]

    @property
    def _pairs(self) -> np.ndarray:
        normal = (self.normal_force, self.approach)
        tangential = (self.tangential_force, self.tangential_displacement)
        pairs = [normal] if tangential == (None, None) else [normal, tangential]
        if any((force is None) == (motion is None) for force, motion in pairs):
            raise ValueError("loads: give either force or translation along each motion")
        return np.array(pairs, dtype=float)

    def after(self, force: np.ndarray, motion: np.ndarray, part: float) -> Loads:
        """Loads interpolated linearly from a state to these loads.

        Parameters
        ----------
        force, motion : ndarray, shape (k,)
            Forces and translations of the holder in that state [N, m].
        part : float
            0 at the state, 1 at these loads.
        """

        def between(start: np.ndarray, end: float | None, k: int) -> float | None:
            return None if end is None else float((1 - part) * start[k] + part * end)

        return Loads(
            between(force, self.normal_force, 0),
            between(motion, self.approach, 0),
            between(force, self.tangential_force, 1),
            between(motion, self.tangential_displacement, 1),
        )
