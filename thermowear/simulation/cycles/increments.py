"""Ends of load increments, cycle jumps and restart points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from ...contact.friction.stick_slip_state import StickSlipState
from ...serialise import serialisable
from .load_path import LoadSegment


@serialisable
@dataclass(frozen=True)
class Jump:
    """Accepted cycle jump.

    Attributes
    ----------
    cycles : int
        Number of cycles.
    error : float
        Estimated error relative to the largest worn depth, before its correction; 0 where each
        cycle was computed, NaN where it was not estimated.
    following : float
        Proposed size of the next jump in cycles.
    """

    cycles: int
    error: float
    following: float


@serialisable
@dataclass(frozen=True)
class Increment:
    """State at the end of a load increment.

    Attributes
    ----------
    time : float
        [s]
    segment : LoadSegment
    ends_segment : bool
    state : StickSlipState
    jump : Jump or None
        Jump that ends here.
    """

    time: float
    segment: LoadSegment
    ends_segment: bool
    state: StickSlipState
    jump: Jump | None = None
    distance: ClassVar[float] = math.nan  # from a steady state

    @property
    def is_output(self) -> bool:
        """True if the increment ends at an output time."""
        return self.ends_segment and self.segment.is_output

    @property
    def restart(self) -> RestartPoint | None:
        """Restart point at the end of a jump, or of a segment before cycle 1; None elsewhere."""
        if self.jump is not None:
            return RestartPoint(self.segment.cycle, self.state, self.jump.following)
        before = self.ends_segment and self.segment.cycle == 0
        return RestartPoint(0, self.state) if before else None


@dataclass(frozen=True)
class RestartPoint:
    """Data to restart the load path from.

    Attributes
    ----------
    cycle : int
        Number of the last computed cycle; 0 before the first.
    state : StickSlipState
    following : float
        Proposed size of the next jump in cycles.
    """

    cycle: int
    state: StickSlipState
    following: float = 2.0
