"""Processes that work off a list of tasks and tell how far they are."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Sequence
from multiprocessing import connection, get_context
from typing import Any

from ..interrupts import deliver_again

_SPAWN = get_context("spawn")  # a copy of a process that has started MPI would not work
_PATIENCE = 60.0  # seconds that interrupted workers have to write down what they have


def work_off(
    tasks: Sequence[Any],
    processes: int,
    work: Callable[[Any, Callable[[Any], None]], None],
    told: Callable[[Any], None],
    lost: Callable[[Any, str], None],
) -> None:
    """Let processes do tasks, each process one at a time.

    Ctrl-C (and SIGTERM) here becomes SIGTERM there: what they tell after it still arrives.

    Parameters
    ----------
    tasks : sequence
        That can be pickled.
    processes : int
    work : callable
        Does a task in a process of its own; called with it and with what tells something. A
        function of a module.
    told : callable
        Called here with each thing told.
    lost : callable
        Called here with a task whose process has died, and why.
    """
    waiting = list(tasks)
    workers = {}
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    try:
        for _ in range(min(processes, len(waiting))):
            worker = _Worker(work)
            workers[worker.pipe] = worker
            worker.begin(waiting.pop(0))
        while workers:
            for pipe in connection.wait(list(workers)):
                if _hear(workers, workers[pipe], told, lost):  # type: ignore[index]
                    _go_on(workers, workers[pipe], waiting, work)  # type: ignore[index]
    except KeyboardInterrupt:
        for worker in workers.values():
            worker.process.terminate()
        _let_finish(workers, told)
        raise


def start_petsc() -> None:
    """Start PETSc so that signals are Python's: Ctrl-C, ``| head``.

    Its options are not read from ``.petscrc`` in the current folder: one of them writes any file.
    """
    import petsc4py

    petsc4py.init(["thermowear", "-no_signal_handler", "-skip_petscrc"])


class _Worker:
    """A process and the pipe to it."""

    def __init__(self, work):
        self.pipe, other = _SPAWN.Pipe()
        self.process = _SPAWN.Process(target=_serve, args=(other, work))
        # Ctrl-C is for us alone: the new process inherits the mask; here it comes in afterwards
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            self.process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        other.close()
        self.task = None

    def begin(self, task: Any) -> None:
        self.task = task
        self.pipe.send((task,))

    def end(self) -> None:
        self.pipe.send(None)
        self.process.join()
        self.pipe.close()


def _hear(workers, worker: _Worker, told, lost) -> bool:
    """Pass on what a worker tells; whether it is ready for another task."""
    try:
        message = worker.pipe.recv()
    except EOFError:
        worker.process.join()
        lost(worker.task, f"its process ended with exit code {worker.process.exitcode}")
        return True
    if message is None:
        return True
    told(message[0])
    return False


def _go_on(workers, worker: _Worker, waiting: list, work) -> None:
    """Give a worker, or a new one in the place of a dead one, another task."""
    if not worker.process.is_alive():
        del workers[worker.pipe]
        if waiting:
            worker = _Worker(work)
            workers[worker.pipe] = worker
    if waiting:
        worker.begin(waiting.pop(0))
    elif worker.pipe in workers:
        del workers[worker.pipe]
        worker.end()


def _let_finish(workers, told) -> None:
    for worker in workers.values():
        try:
            while worker.pipe.poll(_PATIENCE) and (message := worker.pipe.recv()) is not None:
                told(message[0])
        except (EOFError, OSError):
            pass
        worker.process.join(1.0)
        worker.process.kill()


def _serve(pipe, work) -> None:
    """Do tasks until there are no more; in a process of its own."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})  # one that was held back is ignored
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    deliver_again()
    try:
        while (message := pipe.recv()) is not None:
            work(message[0], lambda said: _send(pipe, (said,)))
            _send(pipe, None)
    except (KeyboardInterrupt, EOFError):
        pass


def _send(pipe, message) -> None:
    """Send the whole of a message, whatever signals come."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})
    try:
        pipe.send(message)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
