"""Wall time by phase of a run."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager


class Phases:
    """Seconds spent in named phases; the time of a nested phase is not added to the outer one.

    Parameters
    ----------
    announce : callable, optional
        Called with the name of each phase at its beginning.
    """

    def __init__(self, announce=None):
        self.seconds: dict[str, float] = {}
        self._announce = announce
        self._open: list[str] = []
        self._since = time.perf_counter()

    @contextmanager
    def __call__(self, name: str) -> Iterator[None]:
        self._book()
        self._open.append(name)
        if self._announce is not None:
            self._announce(name)
        try:
            yield
        finally:
            self._book()
            self._open.pop()

    def add(self, name: str, seconds: float) -> None:
        """Add time to a phase, such as that of imports before the timer existed."""
        self.seconds[name] = self.seconds.get(name, 0.0) + seconds

    def _book(self) -> None:
        now = time.perf_counter()
        if self._open:
            self.add(self._open[-1], now - self._since)
        self._since = now
