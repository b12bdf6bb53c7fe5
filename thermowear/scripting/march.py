"""Running-in of a model, step by step."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path

from ..errors import CaseError
from ..model.analyses import TransientAnalysis
from ..output.checkpoint import read_checkpoint, write_checkpoint
from ..parallel import on_root
from ..results import HistoryRow
from ..serialise import Checkpoint, pack
from ..simulation.analyses.transient import TransientHistory
from ..simulation.interface.interface_problem import InterfaceProblem
from ..simulation.results.recording import Snapshot, snapshot_at
from ..simulation.runtime.observer import Observer, Progress, Saved
from ..simulation.system.system import System
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
    problem : InterfaceProblem
    system : System
        Present one, whose meshes may have been moved.
    first : System
        That of the unworn bodies.
    """

    meshes: UserMeshes
    row: HistoryRow
    progress: Progress
    problem: InterfaceProblem
    system: System
    first: System

    @property
    def time(self) -> float:
        """Time [s]."""
        return self.row.time

    @cached_property
    def snapshot(self) -> Snapshot:
        moment = self.progress.state
        return snapshot_at(self.problem, moment.state, moment.time)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the state to a file from which `ScriptedModel.march` continues. Every rank calls.

        An earlier file is replaced once the new one is complete.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        packed = pack(self.first.comm, Saved.now(self.first, self.progress))

        def write() -> None:
            assert packed is not None  # on rank 0
            about = {"time": self.time, "outlines": packed.outlines}
            write_checkpoint(Path(path), about, packed.arrays)

        on_root(self.first.comm, write)


def march(
    meshes: UserMeshes,
    system: System,
    settings: TransientAnalysis,
    start: MarchState | str | PathLike[str] | None,
) -> Iterator[MarchState]:
    """States of a running-in, see `ScriptedModel.march`. Every rank calls."""
    if isinstance(start, MarchState):
        before: Progress | None = start.progress
    else:
        before = None if start is None else _saved(Path(start), system)
    history = TransientHistory(system, settings, Observer())
    for moment in history.states(history.resume(before)):
        history.keep(moment)
        row = history.table(HistoryRow)[-1]
        now = history.loop.now
        yield MarchState(meshes, row, history.progress(), now.problem, now.system, system)


def _saved(path: Path, system: System) -> Progress:
    """Progress of a file of `MarchState.save`. Every rank calls."""
    found = on_root(system.comm, lambda: read_checkpoint(path))
    if found is None:
        raise CaseError(f"march: {path}: there is no such file")
    outlines, arrays = found[0]["outlines"], found[1]
    if len(outlines) != system.comm.size:
        raise CaseError(f"march: {path}: was written by {len(outlines)} processes; use as many")
    try:
        return Checkpoint(outlines, arrays).state(system.comm.rank).of(system)
    except CaseError:
        raise CaseError(
            f"march: {path}: is a state of other bodies, or of another version of thermowear"
        ) from None
