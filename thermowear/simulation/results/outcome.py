"""What every analysis ends with, before it is summed up and written out."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...laws.motions import RigidMotion
from ..interface.body_state import BodyState, ContactState
from ..model.system import System
from .result import FrictionHistory, Interface, Modes, TrackHistory
from .rows import HeatRow, HistoryRow


@dataclass(frozen=True)
class Outcome:
    """What every analysis ends with, before it is written out.

    Attributes
    ----------
    contact : ContactState
    motion : RigidMotion
        How far the holder has moved.
    state : BodyState
    interface : Interface
    extra : dict
        What the analysis adds to the summary.
    history : list of HistoryRow
    outputs : dict of float to Interface
    friction : FrictionHistory or None
        Of a fretting analysis.
    track : TrackHistory or None
        Of a reciprocating analysis.
    heat : list of HeatRow
        Of an analysis that follows temperatures in time.
    stopped : BaseException or None
    modes : Modes or None
        Of a stability analysis.
    system : System or None
        That it ends with, if its meshes have been moved on the way.
    """

    contact: ContactState
    motion: RigidMotion
    state: BodyState
    interface: Interface
    extra: dict
    history: list[HistoryRow]
    outputs: dict[float, Interface]
    friction: FrictionHistory | None = None
    track: TrackHistory | None = None
    heat: list[HeatRow] = field(default_factory=list)
    stopped: BaseException | None = None
    modes: Modes | None = None
    system: System | None = None
