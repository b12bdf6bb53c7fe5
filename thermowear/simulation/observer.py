"""Who watches a run."""

from __future__ import annotations

from .result import (
    CycleRow,
    FrictionInterface,
    HeatRow,
    HistoryRow,
    Interface,
    LoadRow,
    WornTrack,
)


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
