"""Rendering process: a line of JSON with a job on stdin, one with the reason of a failure back."""

from __future__ import annotations

import json
import os
import select
import signal
import sys
from contextlib import ExitStack, suppress
from functools import cache

from .display import display
from .renderer import WARM_UP, attempt


def serve() -> None:
    """Draw until there are no more jobs; if VTK cannot draw, each job that needs it hears why."""
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # libraries may print
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # which ends the X server, too
    with ExitStack() as opened:

        @cache
        def hindrance() -> str:
            try:
                opened.enter_context(display())
            except OSError as error:
                return str(error)
            return ""

        if not select.select([sys.stdin], [], [], 0.0)[0] and not hindrance():
            attempt(*WARM_UP)
        for line in sys.stdin:
            kind, arguments, in_space = json.loads(line)
            answer = (hindrance() if in_space else "") or attempt(kind, arguments)
            print(json.dumps(answer), file=answers, flush=True)


if __name__ == "__main__":
    with suppress(KeyboardInterrupt):
        serve()
    os._exit(0)  # libraries of graphics take their time at the end, or crash
