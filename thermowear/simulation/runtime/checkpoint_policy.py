"""Saving an analysis on its way."""

from __future__ import annotations

import time
from typing import Any, Protocol

import numpy as np

from ...case.tables.analyses import Fretting, Timed
from ..model.system import System
from .checkpoint_data import Progress, Saved
from .observer import Observer


class KeptStates(Protocol):
    """What an analysis keeps of the states that it goes through."""

    def keep(self, state: Any) -> None:
        """Take up a state."""

    def progress(self) -> Progress | None:
        """All that is needed to go on, made of what `checkpoint.pack` knows; None if not yet."""


class Saving:
    """Saves at output times, and when a while has passed since the last time.

    Parameters
    ----------
    system : System
        That the analysis begins with.
    record : KeptStates
    observer : Observer
        Told of what is to be saved.
    """

    def __init__(self, system: System, record: KeptStates, observer: Observer):
        settings = system.case.analysis
        assert isinstance(settings, Timed | Fretting)
        self._system = system
        self._record = record
        self._observer = observer
        self._every = settings.checkpoint_every
        self._last = -np.inf  # the first state is saved at once

    def passed(self, state) -> None:
        """Save if it is time to; every rank calls with each state that has been kept."""
        waited = time.monotonic() - self._last >= self._every
        if state.is_output or self._system.comm.bcast(waited):
            self.save()

    def save(self) -> None:
        """Save in any case; every rank calls."""
        progress = self._record.progress()
        if progress is not None:
            with self._system.phases("checkpoint"):
                self._observer.checkpoint(Saved.now(self._system, progress))
            self._last = time.monotonic()
