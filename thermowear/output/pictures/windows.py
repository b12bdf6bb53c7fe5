"""Windows and colour ranges of pictures of the bodies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

FLAT = 0.55
"""Aspect ratio (height over width) below which the colour bar is placed below a window."""
_SMALL_CONTACT = (
    0.15  # size of a contact relative to the bodies, below which it gets its own window
)
_WINDOW_SIZE = 3.0  # width of that window relative to the size of the contact
_MARGIN = 0.02
_PERCENTILE = 99.5  # percentile of the samples at the end of the colour range

Extent = tuple[float, float, float, float]  # left, right, lower, upper [mm]


def whole(points: np.ndarray) -> Extent:
    """Window of all points, shape (n, 2 or 3) [mm]."""
    (x0, y0), (x1, y1) = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    margin = _MARGIN * max(x1 - x0, y1 - y0)
    return x0 - margin, x1 + margin, y0 - margin, y1 + margin


def around_contact(interfaces: Sequence[dict[str, np.ndarray]]) -> Extent | None:
    """Window around all points in contact in any of the states; None without contact.

    Parameters
    ----------
    interfaces : sequence of dict
        Columns of ``interface.csv``.
    """
    pressed = [table["pressure"] > 0 for table in interfaces]
    if not any(p.any() for p in pressed):
        return None
    x, y = (
        1e3 * np.concatenate([t[axis][p] for t, p in zip(interfaces, pressed, strict=True)])
        for axis in "xy"
    )
    reach = _WINDOW_SIZE / 2 * max(np.ptp(x), np.ptp(y))
    x, y = (v.min() + np.ptp(v) / 2 for v in (x, y))
    return x - reach, x + reach, y - reach, y + reach


def is_small(contact: Extent, points: np.ndarray) -> bool:
    """True if a contact is small relative to bodies with these points, and gets its own window."""
    return bool(contact[1] - contact[0] < _WINDOW_SIZE * _SMALL_CONTACT * np.ptp(points[:, 0]))


def within(contact: Extent, points: np.ndarray) -> Extent:
    """Limit the window to the width of bodies with these points."""
    x = points[:, 0]
    return max(contact[0], x.min()), min(contact[1], x.max()), *contact[2:]


def color_limits(values: np.ndarray) -> tuple[float, float]:
    """Colour range without the few samples near singular edges."""
    low, high = float(values.min()), float(np.percentile(values, _PERCENTILE))
    return (low, high) if high > low else (low - 0.5, low + 0.5)


def common_limits(states: Sequence[np.ndarray]) -> tuple[float, float]:
    """Common colour range of several states."""
    lows, highs = zip(*(color_limits(values) for values in states), strict=True)
    return min(lows), max(highs)
