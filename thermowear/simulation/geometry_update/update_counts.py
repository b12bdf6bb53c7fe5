"""Counters of the geometry updates of a run over successive meshes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import add
from typing import Any

import numpy as np

from ...serialise import serialisable
from ..system.worn_geometry import WornGeometry

_COMBINED: dict[str, Callable[[Any, Any], Any]] = {
    "updates": add,
    "meshed_anew": add,
    "quality": min,
}
"""Combination of the counters of successive meshes, by default the largest."""


@serialisable
@dataclass(frozen=True)
class UpdateCounts:
    """Number of updates, and their worst errors and cell quality; see `WornGeometry`.

    A mesh for a wider zone starts with no updates; the counts of previous meshes are kept here.
    """

    updates: int = 0
    quality: float = float("inf")
    volume_error: float = 0.0
    change: float = 0.0
    heat_error: float = 0.0
    meshed_anew: int = 0
    carrying_error: float = 0.0

    def counting(self, worn: WornGeometry | None) -> UpdateCounts:
        """Counters including the updates of a mesh."""
        if worn is None:
            return self
        pairs = {name: (value, getattr(worn, name)) for name, value in vars(self).items()}
        return UpdateCounts(**{name: _COMBINED.get(name, max)(*v) for name, v in pairs.items()})

    def summary(self, largest_kept: float, lost: np.ndarray) -> dict[str, float | int]:
        """Summary entries; empty without updates.

        Parameters
        ----------
        largest_kept : float
            Largest wear kept in the gap, relative to the dimensions of the bodies.
        lost : ndarray, shape (2,)
            Volumes that the meshes have lost [m³].
        """
        if self.updates == 0:
            return {}
        return {
            "geometry_updates": self.updates,
            "geometry_largest_kept": largest_kept,
            "geometry_smallest_scaled_jacobian": self.quality,
            "geometry_volume_1_m3": float(lost[0]),
            "geometry_volume_2_m3": float(lost[1]),
            "geometry_volume_error": self.volume_error,
            "geometry_change": self.change,
            "geometry_temperature_error": self.heat_error,
            "geometry_meshed_anew": self.meshed_anew,
            "geometry_remeshing_error": self.carrying_error,
        }
