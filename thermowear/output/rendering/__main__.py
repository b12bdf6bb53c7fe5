"""Rendering process: a line of JSON with a job on stdin, one with the reason of a failure back."""

from __future__ import annotations

import json
import os
import select
import signal
import sys
from contextlib import ExitStack, suppress

from .display import display
from .jobs import WARM_UP, attempt


def serve() -> None:
    """Draw until there are no more jobs; where VTK cannot draw, each job hears why."""
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # libraries may print
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # which ends the X server, too
    reason = ""
    with ExitStack() as opened:
        try:
            opened.enter_context(display())
        except OSError as error:
            reason = str(error)
        if not reason and not select.select([sys.stdin], [], [], 0.0)[0]:
            attempt(*WARM_UP)
        for line in sys.stdin:
            print(json.dumps(reason or attempt(*json.loads(line))), file=answers, flush=True)


if __name__ == "__main__":
    with suppress(KeyboardInterrupt):
        serve()
    os._exit(0)  # libraries of graphics take their time at the end, or crash
