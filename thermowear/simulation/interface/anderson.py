"""Anderson acceleration of fixed-point iterations."""

from __future__ import annotations

import numpy as np

_REMEMBERED = 6


class Mixing:
    """Anderson mixing of the last iterates, without damping.

    Walker and Ni, SIAM J. Numer. Anal. 49 (2011) 1715.
    """

    def __init__(self) -> None:
        self._tried: list[np.ndarray] = []
        self._missed: list[np.ndarray] = []

    def next(self, tried: np.ndarray, missed: np.ndarray) -> np.ndarray:
        """Next iterate from the present one and its residual (image minus iterate), shape (k,)."""
        self._tried = [*self._tried, tried][-_REMEMBERED:]
        self._missed = [*self._missed, missed][-_REMEMBERED:]
        if len(self._tried) == 1:
            return tried + missed
        Δtried, Δmissed = np.diff(self._tried, axis=0).T, np.diff(self._missed, axis=0).T
        mixing = np.linalg.lstsq(Δmissed, missed, rcond=1e-12)[0]
        return tried + missed - (Δtried + Δmissed) @ mixing
