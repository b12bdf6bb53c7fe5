"""Times at which the edge of the worn zone reaches contact points.

A point with pointwise contact takes up pressure within about the time in which wear equals the
deflection under it. Steps that end just after this time are the largest ones that resolve it; the
time is extrapolated from the gaps of the points.
"""

from __future__ import annotations

import numpy as np


def closing_times(start: np.ndarray, middle: np.ndarray, end: np.ndarray, step: float):
    """Closing times of gaps, from the beginning of a step.

    Gaps open at the end of the step close at the zero of the parabola through all three values, or
    at its vertex if it has none; gaps open until the middle, at the zero of the line.

    Parameters
    ----------
    start, middle, end : ndarray, shape (n,)
        Gaps, 0 at closed points, NaN if unknown [m].
    step : float
        Step length [s].

    Returns
    -------
    ndarray, shape (n,)
        Closing times, infinite for gaps that open, are unknown or were closed until the middle [s].
    """
    slope = (start - 4 * middle + 3 * end) / step
    bend = 4 * (start - 2 * middle + end) / step**2
    with np.errstate(divide="ignore", invalid="ignore"):
        fall = np.sqrt(np.maximum(slope**2 - 2 * bend * end, 0.0)) - slope
        later = np.where(fall > 0.0, step + 2 * end / fall, np.inf)
        within = np.where((middle > 0.0) & (start > middle), start / (start - middle), np.inf)
    times = np.where(end > 0.0, later, step / 2 * within)
    return np.where(np.isnan(times), np.inf, times)
