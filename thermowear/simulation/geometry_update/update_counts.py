"""Counters of the geometry updates of a run over successive meshes."""

from __future__ import annotations

from dataclasses import dataclass

from ...serialise import serialisable
from ..system.worn_geometry import WornGeometry


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
        return UpdateCounts(
            updates=self.updates + worn.updates,
            quality=min(self.quality, worn.quality),
            volume_error=max(self.volume_error, worn.volume_error),
            change=max(self.change, worn.change),
            heat_error=max(self.heat_error, worn.heat_error),
            meshed_anew=self.meshed_anew + worn.meshed_anew,
            carrying_error=max(self.carrying_error, worn.carrying_error),
        )
