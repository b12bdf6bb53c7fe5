"""Stop signals (Ctrl-C, SIGTERM) deferred to the end of a step."""

from __future__ import annotations

from ...interrupts import RecordedSignals


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
