"""Interrupts that are raised inside a destructor, which Python reports and forgets."""

from __future__ import annotations

import signal
import sys
import threading

_LATER = 0.01
"""When the destructor has been left [s]."""


def deliver_again() -> None:
    """From now on raise such an interrupt once more, a moment later."""
    report = sys.unraisablehook

    def hook(unraisable) -> None:
        if not isinstance(unraisable.exc_value, KeyboardInterrupt):
            report(unraisable)
            return
        heard = callable(signal.getsignal(signal.SIGINT))  # workers hear SIGTERM alone
        number = signal.SIGINT if heard else signal.SIGTERM
        main = threading.main_thread().ident
        again = threading.Timer(_LATER, signal.pthread_kill, (main, number))
        again.daemon = True
        again.start()

    sys.unraisablehook = hook
