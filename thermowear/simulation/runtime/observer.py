"""Who watches a run."""

from __future__ import annotations

from collections.abc import Sequence

from ..results.result import Frame, FrictionInterface, Interface, WornTrack
from ..results.rows import CycleRow, HeatRow, HistoryRow, LoadRow
from .checkpoint_data import Saved


class Observer:
    """Told what happens during a run; the base class ignores it. Called on every rank."""

    def phase(self, name: str) -> None:
        """A phase of the run begins."""

    def step(self, row: HistoryRow, distance: float) -> None:
        """A step of a transient analysis was accepted, at a distance from the steady pressure."""

    def heat(self, row: HeatRow) -> None:
        """The heat of that step, where temperatures are followed in time."""

    def load_step(self, row: LoadRow) -> None:
        """An increment of a fretting analysis was accepted."""

    def cycle(self, row: CycleRow) -> None:
        """A cycle of a fretting analysis has ended."""

    def note(self, text: str) -> None:
        """Something the user should know."""

    def output(
        self,
        time: float,
        interface: Interface,
        friction: FrictionInterface | None = None,
        track: WornTrack | None = None,
    ) -> None:
        """An output time was reached."""

    def checkpoint(self, saved: Saved) -> None:
        """The analysis could go on from here later; what is saved differs from rank to rank."""

    def resumed(self, rows: Sequence[HistoryRow | HeatRow | LoadRow | CycleRow]) -> None:
        """Rows of one kind that were known before the analysis went on."""

    def frame(self, frame: Frame) -> None:
        """A state of an animation was reached."""
