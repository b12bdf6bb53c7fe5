"""Interrupts (Ctrl-C, SIGTERM) where Python raises them in a place that cannot pass them on."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import suppress

_SIGNALS = (signal.SIGINT, signal.SIGTERM)

_DELAY = 0.01
"""Delay after which the destructor has returned [s]."""
_PATIENCE = 5.0
"""Time in which a recorded request must be served, and a signal must be heard [s]."""
BEFORE_FORCED_END: list[Callable[[], object]] = []
"""Functions without arguments that are called before the process ends by force."""
_HEARD = threading.Event()
"""Set by the handler of a signal, which runs as soon as the main thread executes Python."""


class RecordedSignals:
    """Context manager that records Ctrl-C or SIGTERM; a second one interrupts at once.

    It is sent by itself if the block does not end soon.

    Signals ignored by the process stay ignored. Outside the main thread nothing is recorded, as
    Python delivers no signals there.
    """

    def __init__(self) -> None:
        self.recorded: int | None = None
        self._before: dict = {}
        self._again: threading.Timer | None = None

    def __enter__(self):
        if threading.current_thread() is threading.main_thread():
            for number in _SIGNALS:
                if callable(signal.getsignal(number)):
                    self._before[number] = signal.signal(number, self._record)
        return self

    def __exit__(self, kind, error, traceback) -> None:
        if self._again is not None:
            self._again.cancel()
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _record(self, number, frame) -> None:
        _HEARD.set()
        if self.recorded is not None:
            raise KeyboardInterrupt
        self.recorded = number
        self._again = _send_later(_PATIENCE, number)


class DeferredSignals(RecordedSignals):
    """Context manager at whose end a recorded signal is delivered to the handler around it.

    For calls of libraries by ctypes: an interrupt raised while it converts an argument becomes a
    `ctypes.ArgumentError`, which a caller takes for a failure of the library.
    """

    def __exit__(self, kind, error, traceback) -> None:
        super().__exit__(kind, error, traceback)
        if self.recorded is not None:
            signal.raise_signal(self.recorded)


class ForcedEnd:
    """Context manager in which Ctrl-C and SIGTERM end the process, however long a library computes.

    Python's handlers, which raise KeyboardInterrupt here, wait for the end of such a call; then the
    process ends by force, with records of its folders closed.

    Parameters
    ----------
    code : int
        Exit code of the process.
    """

    def __init__(self, code: int):
        self._code, self._before = code, dict[int, object]()

    def __enter__(self):
        for number in _SIGNALS:
            if callable(signal.getsignal(number)) or number == signal.SIGTERM:
                self._before[number] = signal.signal(number, _interrupt)
        self._read, self._write = os.pipe()
        os.set_blocking(self._write, False)
        self._earlier = signal.set_wakeup_fd(self._write, warn_on_full_buffer=False)
        self._watch = threading.Thread(target=self._watching, daemon=True)
        self._watch.start()
        return self

    def __exit__(self, kind, error, traceback) -> None:
        signal.set_wakeup_fd(self._earlier)
        _HEARD.set()
        os.write(self._write, bytes(1))  # ends the thread, also where a child inherited the pipe
        self._watch.join()
        for end in (self._read, self._write):
            os.close(end)
        for number, handler in self._before.items():
            signal.signal(number, handler)  # type: ignore[arg-type]

    def _watching(self) -> None:
        received = b""
        while 0 not in received:
            received = os.read(self._read, 64)
            if not set(received).isdisjoint(_SIGNALS) and not _HEARD.wait(_PATIENCE):
                for action in BEFORE_FORCED_END:
                    with suppress(Exception):
                        action()
                os.write(2, b"error: interrupted\n")
                os._exit(self._code)
            _HEARD.clear()


def _interrupt(number, frame) -> None:
    _HEARD.set()
    raise KeyboardInterrupt


def _send_later(delay: float, number: int) -> threading.Timer:
    """Send a signal to the main thread after a delay [s], unless it is cancelled."""
    main = threading.main_thread().ident
    timer = threading.Timer(delay, signal.pthread_kill, (main, number))
    timer.daemon = True
    timer.start()
    return timer


def deliver_again() -> None:
    """Install a hook that raises an interrupt lost in a destructor again, a moment later."""
    report = sys.unraisablehook

    def hook(unraisable) -> None:
        if not isinstance(unraisable.exc_value, KeyboardInterrupt):
            report(unraisable)
            return
        heard = callable(signal.getsignal(signal.SIGINT))  # workers handle SIGTERM only
        number = signal.SIGINT if heard else signal.SIGTERM
        _send_later(_DELAY, number)

    sys.unraisablehook = hook
