"""Colours, colour ranges and windows of pictures of the bodies and of the contact face."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

COLORS = {
    "temperature": "inferno",
    "von_mises": "viridis",
    "pressure": "viridis",
    "shape": "cividis",
    "wear": "magma_r",
}
"""Colour maps of quantities, of bodies 1 and 2 alike."""
_SMALL_CONTACT = 0.15
"""Size of a contact relative to the bodies, below which it gets its own window."""
_WINDOW_SIZE = 3.0  # width of that window relative to the size of the contact
_MARGIN = 0.02
_PERCENTILE = 99.5  # percentile of the samples at the end of the colour range

Extent = tuple[float, float, float, float]  # left, right, lower, upper [mm]
Limits = tuple[float, float]


def whole(points: np.ndarray) -> Extent:
    """Window of all points, shape (n, 2) [mm]."""
    (x0, y0), (x1, y1) = points.min(axis=0), points.max(axis=0)
    margin = _MARGIN * max(x1 - x0, y1 - y0)
    return x0 - margin, x1 + margin, y0 - margin, y1 + margin


def contact_window(
    interfaces: Sequence[Mapping[str, np.ndarray]], points: np.ndarray
) -> Extent | None:
    """Window around a contact that is small relative to the bodies; None if it is not.

    Parameters
    ----------
    interfaces : sequence of mapping
        Columns of ``interface.csv`` of one or more states; the window shows all their contacts.
    points : ndarray, shape (n, 2)
        Points of the bodies [mm].
    """
    pressed = [table["pressure"] > 0 for table in interfaces]
    x, y = (
        1e3 * np.concatenate([t[axis][p] for t, p in zip(interfaces, pressed, strict=True)])
        for axis in "xy"
    )
    if not len(x):
        return None
    reach = _WINDOW_SIZE / 2 * max(np.ptp(x), np.ptp(y))
    if 2 * reach >= _WINDOW_SIZE * _SMALL_CONTACT * np.ptp(points[:, 0]):
        return None
    x, y = (v.min() + np.ptp(v) / 2 for v in (x, y))
    left, right = points[:, 0].min(), points[:, 0].max()
    return max(x - reach, left), min(x + reach, right), y - reach, y + reach


def inside(points: np.ndarray, window: Extent, margin: float = 0.0) -> np.ndarray:
    """Mask of the points in a window, with a margin relative to its size."""
    left, right, lower, upper = window
    low = np.array([left, lower]) - margin * np.array([right - left, upper - lower])
    high = np.array([right, upper]) + margin * np.array([right - left, upper - lower])
    return np.asarray(((points >= low) & (points <= high)).all(axis=1))


def proportion(window: Extent) -> float:
    """Height of a window over its width."""
    left, right, lower, upper = window
    return (upper - lower) / (right - left)


def color_limits(*states: np.ndarray) -> Limits:
    """Common colour range of several states, without the few samples near singular edges."""
    lows, highs = zip(*((v.min(), np.percentile(v, _PERCENTILE)) for v in states), strict=True)
    low, high = float(min(lows)), float(max(highs))
    return (low, high) if high > low else (low - 0.5, low + 0.5)


def add_color_bar(axis: Axes, colors: str, limits: Limits, largest: float, **options) -> None:
    """Add a colour bar, with a tip if the largest value is beyond its limits."""
    extend = "max" if largest > limits[1] * (1 + 1e-9) else "neither"
    scale = ScalarMappable(Normalize(*limits), colors)
    axis.figure.colorbar(scale, extend=extend, **options)
