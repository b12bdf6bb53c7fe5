"""Pool of processes that compute tasks and report their progress."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Sequence
from multiprocessing import connection, get_context
from typing import Any

from ..interrupts import deliver_again

_SPAWN = get_context("spawn")  # fork does not work after MPI was initialised
_FINISH_TIME = 60.0  # seconds for interrupted workers to write their results


def work_off(
    tasks: Sequence[Any],
    processes: int,
    work: Callable[[Any, Callable[[Any], None]], None],
    received: Callable[[Any], None],
    lost: Callable[[Any, str], None],
) -> None:
    """Distribute tasks to processes, one task per process at a time.

    An interrupt (Ctrl-C, SIGTERM) of this process is passed on to the workers as SIGTERM; their
    last messages are still received.

    Parameters
    ----------
    tasks : sequence
        Tasks that can be pickled.
    processes : int
    work : callable
        Function of a module that computes a task in a worker process; called with the task and a
        function that sends a message.
    received : callable
        Called in this process with each message.
    lost : callable
        Called in this process with a task whose process has died, and the reason.
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
                if _receive(workers, workers[pipe], received, lost):  # type: ignore[index]
                    _assign_next(workers, workers[pipe], waiting, work)  # type: ignore[index]
    except KeyboardInterrupt:
        for worker in workers.values():
            worker.process.terminate()
        _collect_remaining(workers, received)
        raise


def start_petsc() -> None:
    """Initialise PETSc with Python's signal handlers (Ctrl-C, ``| head``).

    Options in a ``.petscrc`` of the current folder are ignored, as one of them can write any file.
    """
    import petsc4py

    petsc4py.init(["thermowear", "-no_signal_handler", "-skip_petscrc"])


class _Worker:
    """Worker process and the pipe to it."""

    def __init__(self, work):
        self.pipe, other = _SPAWN.Pipe()
        self.process = _SPAWN.Process(target=_serve, args=(other, work))
        # only this process handles Ctrl-C: the new one inherits the mask; here it is delayed
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


def _receive(workers, worker: _Worker, received, lost) -> bool:
    """Forward a message of a worker; returns True if it is ready for another task."""
    try:
        message = worker.pipe.recv()
    except EOFError:
        worker.process.join()
        lost(worker.task, f"its process ended with exit code {worker.process.exitcode}")
        return True
    if message is None:
        return True
    received(message[0])
    return False


def _assign_next(workers, worker: _Worker, waiting: list, work) -> None:
    """Assign another task to a worker, or to a new worker that replaces a dead one."""
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


def _collect_remaining(workers, received) -> None:
    for worker in workers.values():
        try:
            while worker.pipe.poll(_FINISH_TIME) and (message := worker.pipe.recv()) is not None:
                received(message[0])
        except (EOFError, OSError):
            pass
        worker.process.join(1.0)
        worker.process.kill()


def _serve(pipe, work) -> None:
    """Main loop of a worker process: compute tasks until there are no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})  # a pending one is ignored
    ended = False

    def end(number, frame):
        nonlocal ended
        ended = True
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, end)
    deliver_again()
    try:
        while (message := pipe.recv()) is not None:
            work(message[0], lambda message: _send(pipe, (message,)))
            _send(pipe, None)
    except (KeyboardInterrupt, EOFError):
        pass
    except Exception:
        if not ended:  # a library may turn the interrupt into an error of its own
            raise


def _send(pipe, message) -> None:
    """Send a complete message, with SIGTERM blocked."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})
    try:
        pipe.send(message)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
