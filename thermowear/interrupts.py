"""Interrupts (Ctrl-C, SIGTERM) where Python raises them in a place that cannot pass them on."""

from __future__ import annotations

import signal
import sys
import threading

_SIGNALS = (signal.SIGINT, signal.SIGTERM)

_DELAY = 0.01
"""Delay after which the destructor has returned [s]."""


class RecordedSignals:
    """Context manager that records Ctrl-C or SIGTERM; a second one interrupts at once.

    Signals ignored by the process stay ignored. Outside the main thread nothing is recorded, as
    Python delivers no signals there.
    """

    def __init__(self) -> None:
        self.recorded: int | None = None
        self._before: dict = {}

    def __enter__(self):
        if threading.current_thread() is threading.main_thread():
            for number in _SIGNALS:
                if callable(signal.getsignal(number)):
                    self._before[number] = signal.signal(number, self._record)
        return self

    def __exit__(self, kind, error, traceback) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _record(self, number, frame) -> None:
        if self.recorded is not None:
            raise KeyboardInterrupt
        self.recorded = number


class DeferredSignals(RecordedSignals):
    """Context manager at whose end a recorded signal is delivered to the handler around it.

    For calls of libraries by ctypes: an interrupt raised while it converts an argument becomes a
    `ctypes.ArgumentError`, which a caller takes for a failure of the library.
    """

    def __exit__(self, kind, error, traceback) -> None:
        super().__exit__(kind, error, traceback)
        if self.recorded is not None:
            signal.raise_signal(self.recorded)


def deliver_again() -> None:
    """Install a hook that raises an interrupt lost in a destructor again, a moment later."""
    report = sys.unraisablehook

    def hook(unraisable) -> None:
        if not isinstance(unraisable.exc_value, KeyboardInterrupt):
            report(unraisable)
            return
        heard = callable(signal.getsignal(signal.SIGINT))  # workers handle SIGTERM only
        number = signal.SIGINT if heard else signal.SIGTERM
        main = threading.main_thread().ident
        again = threading.Timer(_DELAY, signal.pthread_kill, (main, number))
        again.daemon = True
        again.start()

    sys.unraisablehook = hook
