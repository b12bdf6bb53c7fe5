"""Computation of many cases on an executor: cases that share factors stay together."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import chain
from threading import Lock
from typing import Any, Protocol

from ...errors import ComputationError, UnwritableError
from ...interrupts import DeferredSignals

_LONG = 1.0
"""Duration of a chunk from which it is not made larger [s]."""
_MOST = 32
"""Largest number of cases in a chunk: results arrive, and can be resumed from, chunk by chunk."""


class BatchWork(Protocol):
    """Computation of one case, as a picklable callable.

    It returns an outcome that can be pickled. Errors that it raises end the batch.
    """

    def __call__(self, series: Any, task: Any, /) -> Any:
        """Compute a task.

        Parameters
        ----------
        series : simulation.analyses.series.Series
            Series with the set-up results of earlier cases.
        task : object
        """


@dataclass(frozen=True)
class Lost:
    """Outcome of a task whose process has died.

    Attributes
    ----------
    task : object
    reason : str
    """

    task: Any
    reason: str


class Stopped(KeyboardInterrupt):
    """Interrupt of a task, with the outcome of what was computed until then."""

    def __init__(self, outcome: Any):
        super().__init__()
        self.outcome = outcome


@dataclass(frozen=True)
class _Done:
    """Outcomes of a chunk, of its first tasks only if it was stopped, and what stopped it."""

    outcomes: list
    seconds: float
    stop: KeyboardInterrupt | UnwritableError | None = None


@dataclass
class _Slot:
    """Group of tasks that one worker computes, chunk by chunk."""

    tasks: list = field(default_factory=list)
    size: int = 1

    def chunk(self) -> list:
        """Next tasks to compute, which are removed."""
        chosen, self.tasks = self.tasks[: self.size], self.tasks[self.size :]
        return chosen

    def adapt(self, seconds: float) -> None:
        """Choose the size of the next chunk by the duration of the last one."""
        if seconds < _LONG:
            self.size = min(2 * self.size, _MOST)


def compute(
    groups: Sequence[Sequence[Any]],
    work: BatchWork,
    received: Callable[[Any], None],
    executor: Executor | None = None,
    workers: int = 1,
    series=None,
) -> None:
    """Compute tasks, and report their outcomes as they arrive.

    Parameters
    ----------
    groups : sequence of sequence
        Tasks by group; those of a group share set-up results. Idle workers take over half of the
        largest group.
    work : BatchWork
    received : callable
        Called with each outcome.
    executor : Executor, optional
        None computes in this process.
    workers : int
        Number of workers of the executor.
    series : Series, optional
        Series of this process, with set-up results of earlier batches.

    Raises
    ------
    KeyboardInterrupt, UnwritableError
        After the outcomes that running calls return when they are interrupted.
    """
    if executor is None:
        series = series or new_series()
        for task in chain.from_iterable(groups):
            _report(compute_chunk([task], work, series), received)
    else:
        _Distribution(groups, work, received, executor).run(workers)


class _Distribution:
    """Distribution of groups of tasks to the workers of an executor."""

    def __init__(
        self, groups, work: BatchWork, received: Callable[[Any], None], executor: Executor
    ):
        self._groups = sorted(map(list, groups), key=len, reverse=True)
        self._work, self._received, self._executor = work, received, executor
        self._running: dict[Future, tuple[_Slot, list]] = {}

    def run(self, workers: int) -> None:
        """Compute all tasks with a number of workers."""
        slots = [_Slot() for _ in range(workers)]
        try:
            for slot in slots:
                self._start(slot, slots)
            while self._running:
                for future in wait(self._running, return_when=FIRST_COMPLETED)[0]:
                    slot = self._finish(future)
                    self._start(slot, slots)
        except (KeyboardInterrupt, UnwritableError):
            self._interrupt()
            raise

    def _start(self, slot: _Slot, slots: list[_Slot]) -> None:
        """Submit the next chunk of a slot, unless nothing is left."""
        if not slot.tasks:
            self._refill(slot, slots)
        if chosen := slot.chunk():
            future = self._executor.submit(compute_chunk, chosen, self._work)
            self._running[future] = slot, chosen

    def _refill(self, slot: _Slot, slots: list[_Slot]) -> None:
        """Give a slot another group, or half of the tasks that the busiest worker has left."""
        slot.size = 1
        if self._groups:
            slot.tasks = self._groups.pop(0)
            return
        busiest = max(slots, key=lambda one: len(one.tasks))
        kept = (len(busiest.tasks) + 1) // 2
        slot.tasks, busiest.tasks = busiest.tasks[kept:], busiest.tasks[:kept]

    def _finish(self, future: Future) -> _Slot:
        """Report the outcomes of a chunk; tasks of a worker that died follow one by one."""
        slot, tasks = self._running.pop(future)
        done = _result(future, tasks)
        if done is None:
            slot.size, slot.tasks = 1, [*tasks, *slot.tasks]
            return slot
        slot.adapt(done.seconds)
        _report(done, self._received)
        return slot

    def _interrupt(self) -> None:
        """End the executor, and report what running calls return."""
        getattr(self._executor, "interrupt", lambda: None)()
        for future in self._running:
            future.cancel()
        self._executor.shutdown(wait=True)  # that of Dask cannot cancel
        for future, (_, tasks) in self._running.items():
            # of a call that returned nothing; others did
            with suppress(KeyboardInterrupt, UnwritableError):
                if not future.cancelled() and (done := _result(future, tasks)) is not None:
                    _report(done, self._received)


def _report(done: _Done, received: Callable[[Any], None]) -> None:
    for outcome in done.outcomes:
        received(outcome)
    if done.stop is not None:
        raise done.stop


def _result(future: Future, tasks: list) -> _Done | None:
    """Outcomes of a chunk; None if its worker died and its tasks are to be computed one by one."""
    error = CancelledError("cancelled") if future.cancelled() else future.exception()
    if error is None:
        return future.result()
    if not _is_loss(error):
        raise error
    if len(tasks) > 1:
        return None
    own = isinstance(error, ComputationError)
    return _Done([Lost(tasks[0], str(error) if own else f"its process died: {error}")], 0.0)


def _is_loss(error: BaseException) -> bool:
    """Test for the death of a worker, as `ProcessPool` and other executors report it."""
    known = "BrokenExecutor", "KilledWorker", "CancelledError"
    names = {kind.__name__ for kind in type(error).__mro__}
    return isinstance(error, ComputationError) or not names.isdisjoint(known)


_SERIES: list = []
"""Series of a worker process, which keeps the last set-up results for the chunks to come."""
_ALONE = Lock()
"""Held by the thread that computes: neither the series nor PETSc serve several."""


def compute_chunk(tasks: list, work: BatchWork, series=None) -> _Done:
    """Compute tasks one after the other, in this process, by default with the series it keeps.

    Chunks that use the latter wait for each other, where a process has several threads.
    """
    if series is not None:
        return _computed(tasks, work, lambda: series)
    with _ALONE:
        return _computed(tasks, work, _kept_series)


def _computed(tasks: list, work: BatchWork, series: Callable[[], Any]) -> _Done:
    began, outcomes = time.perf_counter(), []
    try:
        own = series()
        for task in tasks:
            outcomes.append(work(own, task))
    except KeyboardInterrupt as stop:
        outcomes += [stop.outcome] if isinstance(stop, Stopped) else []
        return _Done(outcomes, time.perf_counter() - began, KeyboardInterrupt())
    except UnwritableError as stop:
        return _Done(outcomes, time.perf_counter() - began, stop)
    return _Done(outcomes, time.perf_counter() - began)


def _kept_series():
    """Series that this process keeps."""
    if not _SERIES:
        _SERIES.append(new_series(alone=True))
    return _SERIES[0]


def new_series(alone: bool = False):
    """Series of all ranks, or of this process alone."""
    with DeferredSignals():
        start_petsc(alone)
        from mpi4py import MPI

        from ...simulation.analyses.run import Series
    return Series(MPI.COMM_SELF if alone else None)


def start_petsc(alone: bool = False) -> None:
    """Initialise PETSc with Python's signal handlers (Ctrl-C, ``| head``).

    Options in a ``.petscrc`` of the current folder are ignored, as one of them can write any file.

    Parameters
    ----------
    alone : bool
        True on a rank that computes by itself, while others may only wait for its results: all
        ranks would have to initialise PETSc together.
    """
    import petsc4py
    from mpi4py import MPI

    comm = MPI.COMM_SELF if alone else MPI.COMM_WORLD
    petsc4py.init(["thermowear", "-no_signal_handler", "-skip_petscrc"], comm=comm)
