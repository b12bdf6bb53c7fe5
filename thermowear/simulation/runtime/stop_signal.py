"""Stopping between two steps instead of in the middle of one."""

from __future__ import annotations

import signal
import threading

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class StopRequest:
    """Notes Ctrl-C (and SIGTERM) while it is entered; a second one interrupts at once.

    A noted request outlives the block: whoever enters it asks `agreed` once more after it, when
    signals interrupt at once again, so that none is lost in between. Where an error leaves the
    block, a noted request turns it into an interrupt that tells the error.

    Signals that the process ignores stay ignored, and outside the main thread nothing is noted:
    there Python delivers no signals.
    """

    def __init__(self) -> None:
        self._noted = False
        self._before: dict = {}

    def __enter__(self) -> StopRequest:
        if threading.current_thread() is threading.main_thread():
            for number in _SIGNALS:
                if callable(signal.getsignal(number)):
                    self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(self, kind, error, traceback) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)
        if self._noted and isinstance(error, Exception):
            raise interrupted(error)

    def _note(self, number, frame) -> None:
        if self._noted:
            raise KeyboardInterrupt
        self._noted = True

    def agreed(self, comm) -> bool:
        """Whether any rank was asked to stop; every rank calls."""
        return self._noted if comm.size == 1 else any(comm.allgather(self._noted))


def interrupted(reason: BaseException | None = None) -> KeyboardInterrupt:
    """An interrupt; it tells the error that had ended the computation by then, if any."""
    if reason is None:
        return KeyboardInterrupt()
    interrupt = KeyboardInterrupt(f"interrupted; the computation had failed: {reason}")
    interrupt.__cause__ = reason
    return interrupt
