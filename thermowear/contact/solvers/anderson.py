"""Anderson acceleration of fixed-point iterations."""

from __future__ import annotations

import numpy as np


class AndersonMixing:
    """Anderson mixing of the last iterates, without damping.

    Walker and Ni, SIAM J. Numer. Anal. 49 (2011) 1715.

    Parameters
    ----------
    remembered : int
        Number of iterates.
    """

    def __init__(self, remembered: int = 6) -> None:
        self._remembered = remembered
        self._iterates: list[np.ndarray] = []
        self._residuals: list[np.ndarray] = []

    def next(self, iterate: np.ndarray, residual: np.ndarray) -> np.ndarray:
        """Next iterate from the present one and its residual (image minus iterate), shape (k,)."""
        self._iterates = [*self._iterates, iterate][-self._remembered :]
        self._residuals = [*self._residuals, residual][-self._remembered :]
        if len(self._iterates) == 1:
            return iterate + residual
        Δx, Δr = np.diff(self._iterates, axis=0).T, np.diff(self._residuals, axis=0).T
        weights = np.linalg.lstsq(Δr, residual, rcond=1e-12)[0]
        return iterate + residual - (Δx + Δr) @ weights
