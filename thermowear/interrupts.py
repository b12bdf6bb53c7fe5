"""Interrupts that are raised inside a destructor, which Python reports and forgets."""

from __future__ import annotations

import _thread
import signal
import sys


def deliver_again() -> None:
    """From now on raise such an interrupt once more when the destructor is left."""
    report = sys.unraisablehook

    def hook(unraisable) -> None:
        if isinstance(unraisable.exc_value, KeyboardInterrupt):
            heard = callable(signal.getsignal(signal.SIGINT))  # workers hear SIGTERM alone
            _thread.interrupt_main(signal.SIGINT if heard else signal.SIGTERM)
        else:
            report(unraisable)

    sys.unraisablehook = hook
