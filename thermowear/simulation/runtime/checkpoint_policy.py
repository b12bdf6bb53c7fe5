"""Checkpoint policy: times at which an analysis saves its progress."""

from __future__ import annotations

import time
from typing import Any, Protocol

import numpy as np

from ...model.analyses import SteppedAnalysis
from ..model.system import System
from .checkpoint_data import Progress, Saved
from .observer import Observer


class KeptStates(Protocol):
    """Record of the states of an analysis."""

    def keep(self, state: Any) -> None:
        """Record a state."""

    def progress(self) -> Progress | None:
        """Restart data of types known to `checkpoint.pack`; None before the first restart point."""


class Saving:
    """Checkpoints at output times, and after a wall-clock interval since the last one.

    Parameters
    ----------
    system : System
        System that the analysis starts with.
    settings : SteppedAnalysis
    record : KeptStates
    observer : Observer
        Observer that receives the checkpoints.
    """

    def __init__(
        self, system: System, settings: SteppedAnalysis, record: KeptStates, observer: Observer
    ):
        self._system = system
        self._record = record
        self._observer = observer
        self._every = settings.checkpoint_every
        self._last = -np.inf  # the first state is saved at once

    def passed(self, state) -> None:
        """Save if due; every rank calls with each recorded state."""
        waited = time.monotonic() - self._last >= self._every
        if state.is_output or self._system.comm.bcast(waited):
            self.save()

    def save(self) -> None:
        """Save unconditionally; every rank calls."""
        progress = self._record.progress()
        if progress is not None:
            with self._system.phases("checkpoint"):
                self._observer.checkpoint(Saved.now(self._system, progress))
            self._last = time.monotonic()
