"""Observer interface for the events of a run."""

from __future__ import annotations

from collections.abc import Sequence

from ...results import (
    CycleRow,
    Frame,
    FrictionInterface,
    HeatRow,
    HistoryRow,
    InterfaceFields,
    LoadRow,
    WornTrack,
)
from .checkpoint_data import Saved

AnyRow = HistoryRow | HeatRow | LoadRow | CycleRow


class Observer:
    """Callbacks for the events of a run, no-ops in the base class. Called on every rank."""

    def phase(self, name: str) -> None:
        """A phase of the run begins."""

    def row(self, row: AnyRow, distance: float) -> None:
        """A row of a table, at a distance from the steady pressure (NaN without one).

        It records an accepted step of a transient analysis, the heat balance of that step, an
        increment or a cycle of a fretting analysis.
        """

    def note(self, text: str) -> None:
        """A note for the user."""

    def output(
        self,
        time: float,
        interface: InterfaceFields,
        friction: FrictionInterface | None = None,
        track: WornTrack | None = None,
    ) -> None:
        """An output time was reached."""

    def checkpoint(self, saved: Saved) -> None:
        """A checkpoint to restart from; its data differ from rank to rank."""

    def resumed(self, rows: Sequence[AnyRow]) -> None:
        """Rows of one kind from before the restart."""

    def frame(self, frame: Frame) -> None:
        """A state of an animation was reached."""
