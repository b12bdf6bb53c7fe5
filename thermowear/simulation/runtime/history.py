"""History of an analysis: rows of its tables, outputs, animation frames and checkpoints."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Generic, TypeVar

import numpy as np

from ...errors import ComputationError, UnwritableError
from ...interrupts import RecordedSignals
from ...model.analyses import SteppedAnalysis
from ...results import (
    ContactRow,
    CycleRow,
    Frame,
    FrictionHistory,
    HeatRow,
    HistoryRow,
    HolderRow,
    LoadRow,
    ProbeRow,
    Result,
    StickRow,
    TangentialRow,
    TrackHistory,
)
from ..results.recording import Snapshot, fields_of, sample
from ..results.summary import conclude
from ..system.system import System
from .observer import AnyRow, Observer, Progress, Saved

Row = TypeVar("Row", bound=AnyRow)

State = TypeVar("State", bound=Any)
"""Accepted state of an analysis.

It has a `time` [s], `is_output` (true at an output time), and a `distance` from the steady state.
"""


class AnalysisHistory(ABC, Generic[State]):
    """Accepted states of an analysis: rows of its tables, outputs, frames and checkpoints.

    An analysis derives from it its states, the rows and the snapshot of a state, and the data to
    restart from.

    Parameters
    ----------
    system : System
        System that the analysis starts with.
    settings : SteppedAnalysis
    observer : Observer
        Observer notified of each record.
    """

    phase = "time stepping"
    """Name of the phase for timing."""

    def __init__(self, system: System, settings: SteppedAnalysis, observer: Observer):
        self._system = system
        self._observer = observer
        self._settings = settings
        self._tables: dict[str, list] = {}
        self._outputs: dict[float, tuple] = {}
        self._last: State | None = None
        self._restart: tuple[State, dict[str, int], Any] | None = None
        self._saved_at = -np.inf  # the first state is saved at once

    @abstractmethod
    def states(self, last: State | None) -> Iterator[State]:
        """Compute the states after the last one (see `resume`), or from the start, one by one."""

    @abstractmethod
    def rows_of(self, state: State) -> Sequence[AnyRow]:
        """Rows that a state adds to the tables.

        Raises
        ------
        ComputationError
            If its balances do not hold; the state before then remains the last one.
        """

    @abstractmethod
    def snapshot(self, state: State) -> Snapshot:
        """Solve the bodies in a state; every rank calls."""

    @abstractmethod
    def summary(self) -> dict:
        """Entries of the analysis in the summary."""

    def frame_number(self, state: State) -> int | None:
        """Number of a state among those that may be frames, from 0; None for others."""
        return len(self.table(HistoryRow)) - 1

    def may_restart(self, state: State) -> bool:
        """Test whether the analysis can restart from a state."""
        return True

    def restart_data(self) -> Any:
        """Data to restart from beside the last state and the rows."""

    def restore(self, data: Any) -> None:
        """Restore the analysis from its `restart_data`."""

    @property
    def last(self) -> State:
        """Last recorded state."""
        assert self._last is not None
        return self._last

    def table(self, kind: type[Row]) -> list[Row]:
        """Rows of a kind recorded so far."""
        return self._tables.setdefault(kind.__name__, [])

    def resume(self, before: Progress | None) -> State | None:
        """Continue an earlier run, if any; return the state to restart from."""
        if before is None:
            return None
        self._last, self._tables = before.state, before.tables
        self.restore(before.own)
        self._mark_restart(before.state)
        for rows in self._tables.values():
            self._observer.resumed(rows)
        return before.state

    def follow(self, states: Iterable[State]) -> BaseException | None:
        """Record and save successive states; the ones before an error or Ctrl-C are kept.

        A stop request ends the loop after the present state. It also counts after the last one: the
        results of the whole analysis are then written and marked as interrupted.

        Parameters
        ----------
        states : iterable
            At least one state, unless the run was resumed.

        Returns
        -------
        BaseException or None
            Reason for stopping before the end.

        Raises
        ------
        ComputationError
            If the first state fails.
        UnwritableError
            If results cannot be written.
        """
        comm, stopped = self._system.comm, None
        with self._system.phases(self.phase), StopRequest() as stop:
            try:
                for state in states:
                    self.keep(state)
                    if any(comm.allgather(stop.recorded)):
                        break
                    self.save_if_due()
            except UnwritableError:
                raise
            except ComputationError as reason:
                if self._last is None:
                    raise
                stopped = reason
            self.save()
        return interrupted(stopped) if any(comm.allgather(stop.recorded)) else stopped

    def keep(self, state: State) -> None:
        """Record a state: its rows, at an output time its interface, and its animation frame."""
        rows, shown = self.rows_of(state), None
        if state.is_output:
            with self._system.phases("output"):
                shown = self.snapshot(state)
                shown.bodies.require_balance()
        self._last = state
        for row in rows:
            self.table(type(row)).append(row)
            self._observer.row(row, state.distance)
        if shown is not None:
            with self._system.phases("output"):
                self._outputs[state.time] = shown.interface, shown.friction, shown.track
                contacts = shown.system.ranges_by_name
                interface, friction, track = self._outputs[state.time]
                self._observer.output(state.time, interface, friction, track, contacts)
        self._keep_frame(state)
        if self.may_restart(state):
            self._mark_restart(state)

    def save_if_due(self) -> None:
        """Save at output times, and after a wall-clock interval since the last time.

        Every rank calls.
        """
        waited = time.monotonic() - self._saved_at >= self._settings.checkpoint_every
        if self.last.is_output or self._system.comm.bcast(waited):
            self.save()

    def save(self) -> None:
        """Save the progress up to the last state to restart from; every rank calls."""
        if self._restart is None:
            return
        with self._system.phases("checkpoint"):
            saved = Saved.now(self._system, self.progress())
            self._observer.checkpoint(saved)
        self._saved_at = time.monotonic()

    def progress(self) -> Progress:
        """Progress up to the last state to restart from."""
        assert self._restart is not None
        state, counts, own = self._restart
        rows = {kind: self._tables[kind][:count] for kind, count in counts.items()}
        return Progress(state, rows, own)

    def conclude(self, stopped: BaseException | None) -> tuple[Snapshot, Result]:
        """State at the end and result of the analysis; every rank calls."""
        with self._system.phases("bodies"):
            end = self.snapshot(self.last)
        interfaces, frictions, tracks = (
            {time: output[k] for time, output in self._outputs.items()} for k in range(3)
        )
        friction = track = None
        if end.friction is not None:
            friction = FrictionHistory(
                self.table(LoadRow),
                self.table(CycleRow),
                end.friction,
                frictions,
                self.table(StickRow),
                self.table(HolderRow),
                self.table(TangentialRow),
            )
        if end.track is not None:
            track = TrackHistory(end.track, tracks)
        return conclude(
            end,
            self.summary(),
            self.last.time,
            history=self.table(HistoryRow),
            outputs=interfaces,
            friction=friction,
            track=track,
            heat=self.table(HeatRow),
            contact_history=self.table(ContactRow),
            probe_history=self.table(ProbeRow),
            stopped=stopped,
        )

    def _mark_restart(self, state: State) -> None:
        counts = {kind: len(rows) for kind, rows in self._tables.items()}
        self._restart = state, counts, self.restart_data()

    def _keep_frame(self, state: State) -> None:
        """Record an animation frame if the number of the state is selected."""
        number, most = self.frame_number(state), self._settings.frames
        if not most or number is None:
            return
        every = spacing(number, most)
        if number % every:
            return
        with self._system.phases("frames"):
            now = self.snapshot(state)
            fields = fields_of(now.system, sample(now))
            shown = now.interface, fields, now.track, now.system.ranges_by_name
            self._observer.frame(Frame(number, every, state.time, *shown))


def spacing(number: int, most: int) -> int:
    """Smallest power of two with at most `most` multiples from 0 to a number.

    Frames are selected by step numbers: an error-controlled loop takes short steps where the state
    changes fast. Their total is not known in advance, so that all steps are kept until there are
    too many, then every second, then every fourth. The computation does not depend on frames.
    """
    every = 1
    while number // every >= most:
        every *= 2
    return every


class StopRequest(RecordedSignals):
    """Context manager that records Ctrl-C or SIGTERM; a second one interrupts at once.

    A recorded request outlives the block: the caller checks `recorded` once more after it, when
    signals interrupt at once again, so that none is lost in between. If an error leaves the
    block, a recorded request turns it into an interrupt that reports the error.
    """

    def __exit__(self, kind, error, traceback) -> None:
        super().__exit__(kind, error, traceback)
        if self.recorded is not None and isinstance(error, Exception):
            raise interrupted(error)


def interrupted(reason: BaseException | None = None) -> KeyboardInterrupt:
    """KeyboardInterrupt that reports the error that had ended the computation, if any."""
    if reason is None:
        return KeyboardInterrupt()
    interrupt = KeyboardInterrupt(f"interrupted; the computation had failed: {reason}")
    interrupt.__cause__ = reason
    return interrupt
