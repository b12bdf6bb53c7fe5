"""Piecewise linear function of one variable, constant beyond its ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Table1D:
    """Piecewise linear function.

    Attributes
    ----------
    at : tuple of float
        Increasing abscissae, in SI.
    values : tuple of float
        Values at the abscissae.
    """

    at: tuple[float, ...]
    values: tuple[float, ...]

    def value(self, x: np.ndarray | float) -> np.ndarray:
        """Values at an array of any shape."""
        return np.asarray(np.interp(x, self.at, self.values))

    def slope(self, x: np.ndarray | float) -> np.ndarray:
        """Derivative; at corners, that of the next segment."""
        slopes = np.concatenate([[0.0], np.diff(self.values) / np.diff(self.at), [0.0]])
        return slopes[np.searchsorted(self.at, x, side="right")]

    def integral(self, start: float, x: np.ndarray) -> np.ndarray:
        """Integral from `start` to `x`."""
        return self._integral(np.asarray(x, dtype=float)) - self._integral(np.asarray(start))

    def _integral(self, x: np.ndarray) -> np.ndarray:
        """Exact integral from the first abscissa, by the trapezoidal rule."""
        at, values = np.array(self.at), np.array(self.values)
        whole = np.concatenate([[0.0], np.cumsum(np.diff(at) * (values[1:] + values[:-1]) / 2)])
        last = np.maximum(np.searchsorted(at, x, side="right") - 1, 0)
        return whole[last] + (x - at[last]) * (values[last] + self.value(x)) / 2
