"""Times at which the edge of the wear reaches contact points.

A point at which contact holds by itself begins to press at once, within about the time in which
wear takes up the deflection under it. Steps that end right behind such a time are the largest ones
that resolve it; where it is, follows from the gaps of the points before.
"""

from __future__ import annotations

import numpy as np


def closing_times(start: np.ndarray, middle: np.ndarray, end: np.ndarray, step: float):
    """Times from the beginning of a step at which gaps close.

    Those that are open at its end close where the parabola through all three does; where that never
    does, at its vertex. Those that are open until its middle close where the line does.

    Parameters
    ----------
    start, middle, end : ndarray, shape (n,)
        Gaps, 0 where points press, NaN where they are not known [m].
    step : float
        [s]

    Returns
    -------
    ndarray, shape (n,)
        Infinite where they open, are not known or have been closed until the middle [s].
    """
    slope = (start - 4 * middle + 3 * end) / step
    bend = 4 * (start - 2 * middle + end) / step**2
    with np.errstate(divide="ignore", invalid="ignore"):
        fall = np.sqrt(np.maximum(slope**2 - 2 * bend * end, 0.0)) - slope
        later = np.where(fall > 0.0, step + 2 * end / fall, np.inf)
        within = np.where((middle > 0.0) & (start > middle), start / (start - middle), np.inf)
    times = np.where(end > 0.0, later, step / 2 * within)
    return np.where(np.isnan(times), np.inf, times)
