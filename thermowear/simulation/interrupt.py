"""Stopping between two steps instead of in the middle of one."""

from __future__ import annotations

import signal
import threading

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class StopRequest:
    """Notes Ctrl-C (and SIGTERM) while it is entered; a second one interrupts at once.

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

    def __exit__(self, *_) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _note(self, number, frame) -> None:
        if self._noted:
            raise KeyboardInterrupt
        self._noted = True

    def agreed(self, comm) -> bool:
        """Whether any rank was asked to stop; every rank calls."""
        return self._noted if comm.size == 1 else any(comm.allgather(self._noted))
