"""Observer interface for the events of a run, and the checkpoints that it is given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mpi4py import MPI

import numpy as np

from ...errors import CaseError, other_mesh, run_note
from ...results import (
    ContactRow,
    CycleRow,
    Frame,
    FrictionInterface,
    GrowthRow,
    HeatRow,
    HistoryRow,
    HolderRow,
    HotSpotRow,
    InterfaceFields,
    LoadRow,
    ProbeRow,
    StickRow,
    TangentialRow,
    WornTrack,
)
from ...serialise import serialisable
from ..system.system import System

TimedRow = (
    HistoryRow
    | HeatRow
    | ContactRow
    | ProbeRow
    | LoadRow
    | CycleRow
    | StickRow
    | HolderRow
    | TangentialRow
)
AnyRow = TimedRow | HotSpotRow | GrowthRow

_ROUNDING = 1e-9  # relative to the contact's length


@serialisable
@dataclass(frozen=True)
class Progress:
    """Data to restart an analysis from.

    Attributes
    ----------
    state : object
        Accepted state, with its `time` [s].
    tables : dict of str to list
        Rows recorded so far, by the name of their kind.
    own : object
        Restart data of the analysis, see `AnalysisHistory.restart_data`.
    """

    state: Any
    tables: dict[str, list]
    own: Any

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return self.state.time


@serialisable
@dataclass(frozen=True)
class Saved:
    """Checkpoint of an analysis on one rank.

    Attributes
    ----------
    points : ndarray, shape (n, gdim)
        Contact points of the initial bodies [m].
    gap : ndarray, shape (n,)
        Initial gap at these points [m].
    nodes : int
        Number of nodes of this rank.
    moment : ndarray, shape (gdim,)
        Sum of the coordinates of these nodes [m].
    progress : Progress
    mesh : str or None
        Checksum of a mesh read from a file; None for built geometries, which may differ by
        rounding, and in older checkpoints.
    """

    points: np.ndarray
    gap: np.ndarray
    nodes: int
    moment: np.ndarray
    progress: Progress
    mesh: str | None = None

    @classmethod
    def now(cls, system: System, progress: Progress) -> Saved:
        """Checkpoint of an analysis that started with a system."""
        contacts, nodes = system.contacts, system.elastic.nodes()
        mesh = mesh_checksum(system)
        return cls(contacts.points, contacts.gap, len(nodes), nodes.sum(axis=0), progress, mesh)

    def of(self, system: System) -> Progress:
        """Progress of the checkpoint, checked to belong to a system.

        Raises
        ------
        CaseError
            If the bodies differ from those that the analysis started with.
        """
        if self.mesh not in (None, mesh_checksum(system)):
            raise CaseError(other_mesh(system.model.meshes.path))
        if not all(system.comm.allgather(self._began_with(system))):
            raise CaseError(
                "--resume: the meshed bodies are not those of the checkpoint; the initial shape or "
                "the version of a library is another one"
            )
        return self.progress

    def _began_with(self, system: System) -> bool:
        """Compare up to rounding: in parallel a positioned mesh is not bitwise reproducible."""
        other = Saved.now(system, self.progress)
        near = _ROUNDING * max(pairing.extent for pairing in system.contacts.each)
        if (self.nodes, self.gap.shape) != (other.nodes, other.gap.shape):
            return False
        pairs = (self.points, other.points), (self.gap, other.gap)
        errors = [np.abs(one - another).max() for one, another in pairs]
        errors.append(np.abs(self.moment - other.moment).max() / max(self.nodes, 1))
        return max(errors) <= near


def mesh_checksum(system: System) -> str | None:
    """Checksum of the mesh of a system if read from a file; None otherwise."""
    return None if system.model.meshes.path is None else system.bodies.checksum


class Observer:
    """Callbacks for the events of a run, no-ops in the base class. Called on every rank."""

    def phase(self, name: str) -> None:
        """A phase of the run begins."""

    def row(self, row: AnyRow, distance: float) -> None:
        """A row of a table, at a distance from the steady pressure (NaN without one).

        It records an accepted step of a transient analysis, the heat balance of that step, an
        increment or a cycle of a fretting analysis, a mode of hot spots.
        """

    def note(self, text: str) -> None:
        """A note for the user; by default a warning on the first rank."""
        if MPI.COMM_WORLD.rank == 0:
            run_note(text)

    def output(
        self,
        time: float,
        interface: InterfaceFields,
        friction: FrictionInterface | None = None,
        track: WornTrack | None = None,
        contacts: Mapping[str, slice] | None = None,
    ) -> None:
        """An output time was reached; `contacts` are as in `results.Result`."""

    def checkpoint(self, saved: Saved) -> None:
        """A checkpoint to restart from; its data differ from rank to rank."""

    def resumed(self, rows: Sequence[AnyRow]) -> None:
        """Rows of one kind from before the restart."""

    def frame(self, frame: Frame) -> None:
        """A state of an animation was reached."""
