"""What every analysis ends with, before it is summed up and written out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..laws.motions import RigidMotion
from .result import FrictionHistory, HistoryRow, Interface, TrackHistory
from .state import BodyState


@dataclass(frozen=True)
class Outcome:
    """What every analysis ends with, before it is written out.

    Attributes
    ----------
    pressure : ndarray, shape (n,) [Pa]
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
    stopped : BaseException or None
    """

    pressure: np.ndarray
    motion: RigidMotion
    state: BodyState
    interface: Interface
    extra: dict
    history: list[HistoryRow]
    outputs: dict[float, Interface]
    friction: FrictionHistory | None = None
    track: TrackHistory | None = None
    stopped: BaseException | None = None
