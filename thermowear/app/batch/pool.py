"""Executor of processes of this machine that survive a crash of one of them."""

from __future__ import annotations

import os
import signal
import threading
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import connection, get_context
from queue import Empty, SimpleQueue
from typing import Any

from ...errors import CaseNote, ComputationError
from ...interrupts import deliver_again

_SPAWN = get_context("spawn")  # fork does not work after MPI was initialised
_FINISH_TIME = 60.0  # seconds for interrupted workers to return what they have computed


@dataclass(frozen=True)
class _Call:
    """Call of a function in a worker process, and the future of its result."""

    future: Future
    function: Callable
    arguments: tuple
    keywords: dict


class ProcessPool(Executor):
    """Pool of worker processes.

    Other than by `concurrent.futures.ProcessPoolExecutor`, the death of a process fails only the
    call that it was computing, and `interrupt` lets running calls return what they have so far: the
    workers receive SIGTERM, which raises KeyboardInterrupt in the call.

    Parameters
    ----------
    processes : int
    """

    def __init__(self, processes: int):
        os.environ.setdefault("OMP_NUM_THREADS", "1")
        self._waiting: SimpleQueue[_Call] = SimpleQueue()
        self._workers: list[_Worker] = []
        self._closed = False
        self._wake, self._woken = _SPAWN.Pipe()
        self._thread = threading.Thread(target=self._serve, daemon=True)
        for _ in range(processes):
            self._workers.append(_Worker())
        self._thread.start()

    def submit(self, function, /, *arguments, **keywords) -> Future:
        """Schedule a call; see `concurrent.futures.Executor`.

        Raises
        ------
        RuntimeError
            After a shutdown.
        """
        if self._closed:
            raise RuntimeError("the pool of processes has been shut down")
        call = _Call(Future(), function, arguments, keywords)
        self._waiting.put(call)
        self._wake.send(None)
        return call.future

    def interrupt(self) -> None:
        """Interrupt all running calls; those that have not begun are cancelled."""
        self._cancel_waiting()
        for worker in self._workers:
            worker.interrupt()

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the workers after the scheduled calls; see `concurrent.futures.Executor`."""
        if cancel_futures:
            self._cancel_waiting()
        if not self._closed:
            self._closed = True
            self._wake.send(None)
        if wait:
            self._thread.join()

    def _cancel_waiting(self) -> None:
        try:
            while True:
                self._waiting.get_nowait().future.cancel()
        except Empty:
            return

    def _serve(self) -> None:
        """Main loop of the thread that hands calls to workers and receives their results."""
        while True:
            for k, worker in enumerate(self._workers):
                if worker.idle and not worker.process.is_alive():
                    worker = self._workers[k] = _Worker()
                while worker.idle and (call := self._next_call()) is not None:
                    worker.begin(call)
            if self._closed and all(worker.idle for worker in self._workers):
                break
            busy = {worker.pipe: worker for worker in self._workers if not worker.idle}
            for ready in connection.wait([*busy, self._woken]):
                if ready is self._woken:
                    self._woken.recv()
                else:
                    busy[ready].receive()  # type: ignore[index]
        for worker in self._workers:
            worker.end()

    def _next_call(self) -> _Call | None:
        """Next call that has not been cancelled; None without any."""
        try:
            while True:
                call = self._waiting.get_nowait()
                if call.future.set_running_or_notify_cancel():
                    return call
        except Empty:
            return None


class _Worker:
    """Worker process, the pipe to it, and the call that it computes."""

    def __init__(self) -> None:
        self.pipe, other = _SPAWN.Pipe()
        self.process = _SPAWN.Process(target=_work, args=(other,))
        # only the first process handles Ctrl-C: the new one inherits the mask; here it is delayed
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            self.process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        other.close()
        self._call: _Call | None = None

    @property
    def idle(self) -> bool:
        """True if it computes nothing."""
        return self._call is None

    def begin(self, call: _Call) -> None:
        """Send a call to the process; one that cannot be sent fails."""
        self._call = call
        try:
            with _broken_pipes_as_errors():
                self.pipe.send((call.function, call.arguments, call.keywords))
        except OSError:  # the process has just died
            self.receive()
        except Exception as error:
            self._finish(None, error)

    def receive(self) -> None:
        """Receive the result of the call, or that the process has died."""
        try:
            result, error = self.pipe.recv()
        except (EOFError, OSError):
            self.process.join()
            code = self.process.exitcode
            result, error = None, ComputationError(f"its process ended with exit code {code}")
        self._finish(result, error)

    def interrupt(self) -> None:
        """Interrupt the call; a process that does not return soon is killed."""
        if self._call is not None:
            self.process.terminate()
            timer = threading.Timer(_FINISH_TIME, self.process.kill)
            timer.daemon = True
            timer.start()

    def end(self) -> None:
        """End the process."""
        with suppress(OSError), _broken_pipes_as_errors():
            self.pipe.send(None)
        self.process.join(1.0)
        self.process.kill()
        self.pipe.close()

    def _finish(self, result: Any, error: BaseException | None) -> None:
        assert self._call is not None
        future, self._call = self._call.future, None
        if error is None:
            future.set_result(result)
        else:
            future.set_exception(error)


def _work(pipe) -> None:
    """Main loop of a worker process: compute calls until there are no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})  # a pending one is ignored

    def end(number, frame):
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, end)
    deliver_again()
    warnings.simplefilter("ignore", CaseNote)  # would be repeated by each process
    try:
        while (message := pipe.recv()) is not None:
            function, arguments, keywords = message
            answer: tuple[Any, BaseException | None]
            try:
                answer = function(*arguments, **keywords), None
            except (Exception, KeyboardInterrupt) as error:
                answer = None, error
            _send(pipe, answer)
    except (KeyboardInterrupt, EOFError, OSError):
        return


def _send(pipe, answer: tuple[Any, BaseException | None]) -> None:
    """Send a complete answer, with SIGTERM blocked; an error that cannot be sent as its text."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})
    try:
        pipe.send(answer)
    except (OSError, KeyboardInterrupt):
        raise
    except Exception as error:  # the result cannot be pickled
        kept = answer[1] or error
        pipe.send((None, ComputationError(f"{type(kept).__name__}: {kept}")))
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _broken_pipes_as_errors() -> Iterator[None]:
    """Raise an error where a pipe is closed at its other end, whoever handles the signal of it.

    PETSc ends the process at SIGPIPE, unless it was started without its handlers.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGPIPE})
    try:
        yield
    finally:
        if signal.SIGPIPE in signal.sigpending():
            signal.sigtimedwait({signal.SIGPIPE}, 0)
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
