"""Repeated delivery of interrupts raised inside a destructor, which Python reports and discards."""

from __future__ import annotations

import signal
import sys
import threading

_DELAY = 0.01
"""Delay after which the destructor has returned [s]."""


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
