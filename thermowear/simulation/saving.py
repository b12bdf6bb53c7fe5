"""Saving an analysis on its way, and going on with it."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..case.analyses import Fretting, Timed
from ..errors import CaseError
from .checkpoint import can_be_packed
from .observer import Observer
from .system import System

_ROUNDING = 1e-9  # of the contact's length


class Progress(Protocol):
    """How far an analysis has come."""

    @property
    def time(self) -> float:
        """[s]"""


class Record(Protocol):
    """What an analysis keeps of the states that it goes through."""

    def keep(self, state: Any) -> None:
        """Take up a state."""

    def progress(self) -> Progress | None:
        """All that is needed to go on, made of what `checkpoint.pack` knows; None if not yet."""


@can_be_packed
@dataclass(frozen=True)
class Saved:
    """An analysis on its way, on one rank.

    Attributes
    ----------
    points : ndarray, shape (n, gdim)
        Contact points of the bodies that it began with [m].
    gap : ndarray, shape (n,)
        And the gap between them [m].
    nodes : int
        Of this rank.
    moment : ndarray, shape (gdim,)
        Sum of their coordinates [m].
    progress : Progress
    """

    points: np.ndarray
    gap: np.ndarray
    nodes: int
    moment: np.ndarray
    progress: Any

    @classmethod
    def now(cls, system: System, progress: Progress) -> Saved:
        """An analysis that began with a system."""
        pairing, nodes = system.pairing, system.elastic.nodes()
        return cls(pairing.points, pairing.gap, len(nodes), nodes.sum(axis=0), progress)

    def of(self, system: System) -> Any:
        """The progress, of an analysis of a system.

        Raises
        ------
        CaseError
            If its bodies are not those that the analysis began with.
        """
        if not all(system.comm.allgather(self._began_with(system))):
            raise CaseError(
                "--resume: the meshed bodies are not those of the checkpoint; a mesh file, an "
                "initial shape or the version of a library is another one"
            )
        return self.progress

    def _began_with(self, system: System) -> bool:
        """But for rounding: on several ranks a mesh that was positioned is not bitwise the same."""
        other, near = Saved.now(system, self.progress), _ROUNDING * system.pairing.extent
        if (self.nodes, self.gap.shape) != (other.nodes, other.gap.shape):
            return False
        pairs = (self.points, other.points), (self.gap, other.gap)
        errors = [np.abs(one - another).max() for one, another in pairs]
        errors.append(np.abs(self.moment - other.moment).max() / max(self.nodes, 1))
        return max(errors) <= near


class Saving:
    """Saves at output times, and when a while has passed since the last time.

    Parameters
    ----------
    system : System
        That the analysis begins with.
    record : Record
    observer : Observer
        Told of what is to be saved.
    """

    def __init__(self, system: System, record: Record, observer: Observer):
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
