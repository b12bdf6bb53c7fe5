"""Stop signals (Ctrl-C, SIGTERM) deferred to the end of a step."""

from __future__ import annotations

import signal
import threading

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class StopRequest:
    """Context manager that records Ctrl-C or SIGTERM; a second one interrupts at once.

    A recorded request outlives the block: the caller checks `agreed` once more after it, when
    signals interrupt at once again, so that none is lost in between. If an error leaves the
    block, a recorded request turns it into an interrupt that reports the error.

    Signals ignored by the process stay ignored. Outside the main thread nothing is recorded, as
    Python delivers no signals there.
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
        """True if any rank was asked to stop; every rank calls."""
        return self._noted if comm.size == 1 else any(comm.allgather(self._noted))


def interrupted(reason: BaseException | None = None) -> KeyboardInterrupt:
    """KeyboardInterrupt that reports the error that had ended the computation, if any."""
    if reason is None:
        return KeyboardInterrupt()
    interrupt = KeyboardInterrupt(f"interrupted; the computation had failed: {reason}")
    interrupt.__cause__ = reason
    return interrupt
