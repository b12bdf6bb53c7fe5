"""Curves of a variant for bands: its history, and the points of the contact."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...results import Result
from ...results.points import by_contact
from ...results.quantity import table_of

HISTORY = (
    *("max_pressure", "wear_volume_1", "wear_volume_2"),
    *("max_temperature", "max_wear_1", "max_wear_2"),
)
"""Columns of the history with bands."""
POINTS = ("pressure", "shape", "wear_1", "wear_2", "temperature_1", "temperature_2")
"""Columns of the contact points with bands."""
PLACES = ("x", "y", "z", "s")
_MOST_ROWS = 200
Curves = dict[str, dict[str, np.ndarray]]
"""Columns by table."""


def curves_of(result: Result, room: int) -> Curves:
    """Curves of a result.

    Parameters
    ----------
    result : Result
    room : int
        Largest number of values; points of a contact that need more are left out.

    Returns
    -------
    dict of str to dict of str to ndarray
        Columns of ``history`` and of ``interface`` (``interface_CONTACT`` of several bodies) by
        the names of the fields.
    """
    found: Curves = {}
    if result.history:
        rows = result.history
        count = max(2, min(_MOST_ROWS, room // (len(HISTORY) + 1)))
        kept = np.unique(np.linspace(0, len(rows) - 1, count).round().astype(int))
        found["history"] = _columns([rows[k] for k in kept], ("time", *HISTORY))
    points = by_contact(result.interface, result.contacts) or {"": result.interface}
    for name, own in points.items():
        columns = _columns(own, (*PLACES, *POINTS))
        if len(own.x) * len(columns) * len(points) <= room:
            found[f"{table_of(own).stem}_{name}" if name else table_of(own).stem] = columns
    return found


def _columns(source: Any, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Columns of rows or points that have values, and are not zero everywhere."""
    rows = source if isinstance(source, list) else None
    every = {
        name: np.array([getattr(row, name) for row in rows] if rows else getattr(source, name))
        for name in names
    }
    return {
        name: np.asarray(values, dtype=np.float32)
        for name, values in every.items()
        if np.isfinite(values).all() and (name in ("time", *PLACES) or np.any(values != 0.0))
    }
