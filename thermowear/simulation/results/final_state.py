"""Final state of an analysis on one rank, from which its results are evaluated."""

from __future__ import annotations

from dataclasses import dataclass

from ...laws.motions import RigidMotion
from ..interface.body_state import BodyState, ContactState
from ..model.system import System


@dataclass(frozen=True)
class FinalState:
    """Final state of an analysis.

    Attributes
    ----------
    system : System
        Final system, whose meshes may have been moved.
    contact : ContactState
    motion : RigidMotion
        Rigid motion of the holder.
    bodies : BodyState
    """

    system: System
    contact: ContactState
    motion: RigidMotion
    bodies: BodyState
