"""What is saved of an analysis on its way, and what it can go on with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ...case.validation.comparison import other_mesh
from ...errors import CaseError
from ...serialise import serialisable
from ..model.system import System

_ROUNDING = 1e-9  # of the contact's length


class Progress(Protocol):
    """How far an analysis has come."""

    @property
    def time(self) -> float:
        """[s]"""


@serialisable
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
    mesh : str or None
        Checksum of a mesh that was read from a file; built geometries may differ by rounding, and
        older checkpoints have none.
    """

    points: np.ndarray
    gap: np.ndarray
    nodes: int
    moment: np.ndarray
    progress: Any
    mesh: str | None = None

    @classmethod
    def now(cls, system: System, progress: Progress) -> Saved:
        """An analysis that began with a system."""
        pairing, nodes = system.pairing, system.elastic.nodes()
        mesh = mesh_checksum(system)
        return cls(pairing.points, pairing.gap, len(nodes), nodes.sum(axis=0), progress, mesh)

    def of(self, system: System) -> Any:
        """The progress, of an analysis of a system.

        Raises
        ------
        CaseError
            If its bodies are not those that the analysis began with.
        """
        if self.mesh not in (None, mesh_checksum(system)):
            raise CaseError(other_mesh(system.case))
        if not all(system.comm.allgather(self._began_with(system))):
            raise CaseError(
                "--resume: the meshed bodies are not those of the checkpoint; the initial shape or "
                "the version of a library is another one"
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


def mesh_checksum(system: System) -> str | None:
    """Checksum of the mesh of a system that was read from a file; None of any other."""
    return system.bodies.checksum if system.case.geometry.from_file else None
