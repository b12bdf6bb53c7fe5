"""Running-in of a model, step by step."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from ..model.analyses import TransientAnalysis
from ..results import HistoryRow
from ..simulation.analyses.transient import transient_history
from ..simulation.interface.interface_problem import InterfaceProblem
from ..simulation.results.recording import Snapshot, snapshot_at
from ..simulation.runtime.checkpoint_data import Progress
from ..simulation.runtime.observer import Observer
from ..simulation.system.system import System
from .body import MeshBody
from .solution import ContactResults
from .user_mesh import UserMeshes


@dataclass(frozen=True)
class MarchState(ContactResults):
    """State of a running-in after a step; also a state to continue from.

    Attributes
    ----------
    row : HistoryRow
        Row of the history: time, step, wear volumes, largest pressure and temperature, in SI.
    progress : Progress
        Data to continue from.
    """

    bodies: tuple[MeshBody, ...]
    meshes: UserMeshes
    row: HistoryRow
    progress: Progress
    problem: InterfaceProblem
    system: System

    @property
    def time(self) -> float:
        """Time [s]."""
        return self.row.time

    @cached_property
    def snapshot(self) -> Snapshot:
        moment = self.progress.state
        return snapshot_at(self.problem, moment.state, moment.time)


def march(
    bodies: tuple[MeshBody, ...],
    meshes: UserMeshes,
    system: System,
    settings: TransientAnalysis,
    start: MarchState | None,
) -> Iterator[MarchState]:
    """States of a running-in, from the unworn contact or from an earlier state.

    Every rank calls.

    Raises
    ------
    ComputationError
        If a step fails, or its balances do not hold.
    """
    before = None if start is None else start.progress
    history, passing = transient_history(system, settings, Observer(), before)
    for moment in passing:
        history.keep(moment)
        row = history.table(HistoryRow)[-1]
        now = history.loop.now
        yield MarchState(bodies, meshes, row, history.progress(), now.problem, now.system)
