"""Jumps over cycles, as long as their error allows.

A cycle that stands for n wears n times as much. That is not what n cycles would do one after the
other: its error grows with ``n (n - 1)``, for one cycle has none. A jump is done in two parts, and
done again as a whole: the difference D of the depths is ``2 n1 n2`` of the same unknown constant,
so that the parts have the error

    D (n1 (n1 - 1) + n2 (n2 - 1)) / (2 n1 n2)

(Richardson). It decides how far to jump, and is taken out of the depths: what is left is of second
order. Each increment of the cycles is implicit, see `contact.slip_wear`, so that jumps of any size
are stable.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ...contact.friction.gross_slip import FullSliding
from ...contact.friction.stick_slip_state import StickSlipState
from ...errors import ComputationError
from .increments import Increment, Jump, RestartPoint

_SAFETY, _SHORTER, _LONGER = 0.9, 0.2, 5.0


class Cycles(Protocol):
    """Cycles that can be computed."""

    areas: np.ndarray
    """Of the coefficients of the depths, shape (m,) [m²]."""

    def cycle(self, state: StickSlipState, number: int, repeats: int) -> Iterator[Increment]:
        """The increments of a cycle, which stands for all since the one of the state.

        Raises
        ------
        ComputationError
        """

    def settled(self, end: Increment, worn: np.ndarray) -> StickSlipState:
        """The same loads on other worn depths, shape (n_wearing, m) [m], energy as it was."""


def fixed_jumps(
    cycles: Cycles, numbers: Iterable[int], behind: RestartPoint
) -> Iterator[Increment]:
    """Compute the cycles of these numbers, each for all since the one before."""
    for number in numbers:
        if number > behind.cycle:
            span = number - behind.cycle
            for instant in cycles.cycle(behind.state, number, span):
                state = instant.state
                yield _marked(instant, Jump(span, math.nan, span))
            behind = RestartPoint(number, state, span)


def adaptive_jumps(
    cycles: Cycles, stops: Iterable[int], behind: RestartPoint, tolerance: float, longest: float
) -> Iterator[Increment]:
    """Go through all cycles in jumps whose errors are within a tolerance.

    Parameters
    ----------
    cycles : Cycles
    stops : iterable of int
        Cycles that no jump passes, the last one included, in order.
    behind : RestartPoint
    tolerance : float
        Of the largest depth worn.
    longest : float
        The most cycles of a jump.

    Yields
    ------
    Increment
        Of the cycles that the jumps are made of; jumps whose error is too large leave no trace.

    Raises
    ------
    ComputationError
        Of a single cycle.
    """
    for stop in stops:
        while behind.cycle < stop:
            span = _at_most(min(behind.following, longest), stop - behind.cycle)
            wanted = behind.following
            for instant in _jumped(cycles, behind, span, tolerance):
                if instant.jump is not None and instant.leg.cycle == stop:
                    following = max(instant.jump.following, wanted)
                    instant = replace(instant, jump=replace(instant.jump, following=following))
                yield instant
            assert instant.jump is not None  # it ends the jump
            behind = RestartPoint(instant.leg.cycle, instant.state, instant.jump.following)


def _at_most(wanted: float, left: int) -> int:
    """Whole cycles, but none that leaves few over."""
    return left if wanted >= left else max(1, int(min(wanted, math.ceil(left / 2))))


def _jumped(
    cycles: Cycles, behind: RestartPoint, wanted: int, tolerance: float
) -> Iterable[Increment]:
    """The instants of a jump, over half the cycles again and again where its error is too large."""
    start, state, span, whole = behind.cycle, behind.state, wanted, None
    while span > 1:
        n1, n2 = span - span // 2, span // 2
        try:
            whole = whole or list(cycles.cycle(state, start + span, span))
            first = list(cycles.cycle(state, start + n1, n1))
            second = list(cycles.cycle(first[-1].state, start + span, n2))
        except FullSliding:
            raise
        except ComputationError:
            span, whole = n1, None
            continue
        done_twice = _DoneTwice(n1, n2, state, whole[-1].state, second[-1])
        error = done_twice.error
        if error <= tolerance:
            jump = Jump(span, error, span * _growth(error, tolerance))
            return [*first, *second[:-1], replace(done_twice.corrected(cycles), jump=jump)]
        span, whole = n1, first  # which is the whole of the next try
    jump = Jump(1, 0.0, behind.following if wanted == 1 else 2.0)
    return (_marked(instant, jump) for instant in cycles.cycle(state, start + 1, 1))


@dataclass(frozen=True)
class _DoneTwice:
    """A jump in two parts and as a whole; the symbols are those of the module's docstring.

    Attributes
    ----------
    n1, n2 : int
    start, whole : StickSlipState
        Before it, and after it as a whole.
    end : Increment
        Of the second part.
    """

    n1: int
    n2: int
    start: StickSlipState
    whole: StickSlipState
    end: Increment

    @property
    def part(self) -> float:
        """Of the difference, that the two parts are wrong by."""
        single = self.n1 * (self.n1 - 1) + self.n2 * (self.n2 - 1)
        return single / (2 * self.n1 * self.n2)

    @property
    def wrong(self) -> np.ndarray:
        """Depths after the two parts, too much, shape (n_wearing, m) [m]."""
        return self.part * (self.whole.worn - self.end.state.worn)

    @property
    def error(self) -> float:
        """Largest of them, of the largest depth; 0 where nothing wears."""
        largest = float(self.end.state.worn.max(initial=0.0))
        return float(np.abs(self.wrong).max(initial=0.0)) / largest if largest > 0.0 else 0.0

    def corrected(self, cycles: Cycles) -> Increment:
        """The end without the error."""
        if self.part == 0.0:
            return self.end
        state, before = self.end.state, self.start.worn
        worn = before + _forward(state.worn - self.wrong - before, cycles.areas)
        lost = state.dissipated - self.part * (self.whole.dissipated - state.dissipated)
        settled = cycles.settled(self.end, worn)
        return replace(self.end, state=replace(settled, dissipated=lost))


def _growth(error: float, tolerance: float) -> float:
    """Of the next jump; the error goes with the square of the cycles."""
    if error == 0.0:
        return _LONGER
    return float(np.clip(_SAFETY * math.sqrt(tolerance / error), _SHORTER, _LONGER))


def _forward(gains: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """Depths gained, shape (n_wearing, m), without loss: what would come back others do not gain.

    Volumes stay what they are, so that they remain those of the energy.
    """
    kept = np.maximum(gains, 0.0)
    volumes = np.where(kept.any(axis=1), kept @ areas, 1.0)
    return kept * np.maximum(gains @ areas / volumes, 0.0)[:, None]


def _marked(instant: Increment, jump: Jump) -> Increment:
    """With the jump that it ends, if it does."""
    ends = instant.ends_leg and instant.leg.ends_cycle
    return replace(instant, jump=jump) if ends else instant
