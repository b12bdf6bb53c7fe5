"""Ends of increments of a history of loads, and what going on from them takes."""

from __future__ import annotations

from dataclasses import dataclass

from ...contact.friction.stick_slip_state import StickSlipState
from ...serialise import serialisable
from .load_path import LoadSegment


@serialisable
@dataclass(frozen=True)
class Jump:
    """A way over cycles that has been gone.

    Attributes
    ----------
    cycles : int
        How many.
    error : float
        Estimated, of the largest depth worn, before it is taken out; 0 where each cycle was
        computed, NaN where it was not estimated.
    following : float
        How far to jump next, if nothing is in the way.
    """

    cycles: int
    error: float
    following: float


@serialisable
@dataclass(frozen=True)
class Increment:
    """The end of an increment.

    Attributes
    ----------
    time : float
        [s]
    leg : LoadSegment
    ends_leg : bool
    state : StickSlipState
    jump : Jump or None
        That ends here.
    """

    time: float
    leg: LoadSegment
    ends_leg: bool
    state: StickSlipState
    jump: Jump | None = None

    @property
    def is_output(self) -> bool:
        """Whether it is at an output time."""
        return self.ends_leg and self.leg.is_output

    @property
    def behind(self) -> RestartPoint | None:
        """What going on takes: where a jump ends, or a leg before the first cycle; else None."""
        if self.jump is not None:
            return RestartPoint(self.leg.cycle, self.state, self.jump.following)
        before = self.ends_leg and self.leg.cycle == 0
        return RestartPoint(0, self.state) if before else None


@dataclass(frozen=True)
class RestartPoint:
    """Where going on begins: all that it takes.

    Attributes
    ----------
    cycle : int
        Number of the last one; 0 before the first.
    state : StickSlipState
    following : float
        How many cycles the next jump is wanted to have.
    """

    cycle: int
    state: StickSlipState
    following: float = 2.0
