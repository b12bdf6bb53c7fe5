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


class Observer:
    """Callbacks for the events of a run, no-ops in the base class. Called on every rank."""

    def phase(self, name: str) -> None:
        """A phase of the run begins."""

    def step(self, row: HistoryRow, distance: float) -> None:
        """A step of a transient analysis was accepted, at a distance from the steady pressure."""

    def heat(self, row: HeatRow) -> None:
        """Heat balance of that step, for transient temperatures."""

    def load_step(self, row: LoadRow) -> None:
        """An increment of a fretting analysis was accepted."""

    def cycle(self, row: CycleRow) -> None:
        """A cycle of a fretting analysis has ended."""

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

    def resumed(self, rows: Sequence[HistoryRow | HeatRow | LoadRow | CycleRow]) -> None:
        """Rows of one kind from before the restart."""

    def frame(self, frame: Frame) -> None:
        """A state of an animation was reached."""
