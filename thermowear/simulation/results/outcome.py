"""Outcome of an analysis, the common input of summary and results."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...laws.motions import RigidMotion
from ..interface.body_state import BodyState, ContactState
from ..system.system import System
from .result import FrictionHistory, InterfaceFields, Modes, TrackHistory
from .rows import HeatRow, HistoryRow


@dataclass(frozen=True)
class Outcome:
    """Final state of an analysis, before summary and output.

    Attributes
    ----------
    contact : ContactState
    motion : RigidMotion
        Rigid motion of the holder.
    state : BodyState
    interface : InterfaceFields
    extra : dict
        Entries that the analysis adds to the summary.
    history : list of HistoryRow
    outputs : dict of float to InterfaceFields
        Interface at the output times, by time [s].
    friction : FrictionHistory or None
        Results of a fretting analysis.
    track : TrackHistory or None
        Results of a reciprocating analysis.
    heat : list of HeatRow
        Heat history in transient conduction.
    stopped : BaseException or None
        Exception that stopped the analysis early.
    modes : Modes or None
        Results of a stability analysis.
    system : System or None
        Final system, if its meshes have been moved.
    """

    contact: ContactState
    motion: RigidMotion
    state: BodyState
    interface: InterfaceFields
    extra: dict
    history: list[HistoryRow]
    outputs: dict[float, InterfaceFields]
    friction: FrictionHistory | None = None
    track: TrackHistory | None = None
    heat: list[HeatRow] = field(default_factory=list)
    stopped: BaseException | None = None
    modes: Modes | None = None
    system: System | None = None
