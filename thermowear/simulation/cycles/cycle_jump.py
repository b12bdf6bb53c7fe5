"""Cycle jumps with Richardson error control.

A computed cycle that represents n cycles wears n times as much. Compared with n consecutive cycles
its error grows with ``n (n - 1)``, as a single cycle has none. Each jump is computed in two parts
and again as a whole: the difference D of the depths is ``2 n1 n2`` times the unknown error
constant, so that the two parts have the error

    D (n1 (n1 - 1) + n2 (n2 - 1)) / (2 n1 n2)

(Richardson extrapolation). It controls the jump size and is subtracted from the depths, which
leaves an error of second order. Each increment of the cycles is implicit, see
`contact.friction.slip_wear`, so that jumps of any size are stable.
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
from .load_path import Increment, Jump, RestartPoint

_SAFETY, _SHORTER, _LONGER = 0.9, 0.2, 5.0


class Cycles(Protocol):
    """Protocol of a contact with computable load cycles."""

    areas: np.ndarray
    """Areas of the basis functions of the depths, shape (m,) [m²]."""

    def cycle(self, state: StickSlipState, number: int, repeats: int) -> Iterator[Increment]:
        """Increments of a cycle that represents all cycles since that of the state.

        Raises
        ------
        ComputationError
        """

    def equilibrium(self, end: Increment, state: StickSlipState) -> StickSlipState:
        """State at equal loads and energy with the wear of another state."""


def fixed_jumps(
    cycles: Cycles, numbers: Iterable[int], restart: RestartPoint
) -> Iterator[Increment]:
    """Compute the cycles of these numbers, each representing all since the previous one."""
    for number in numbers:
        if number > restart.cycle:
            span = number - restart.cycle
            for increment in cycles.cycle(restart.state, number, span):
                state = increment.state
                yield _marked(increment, Jump(span, math.nan, span))
            restart = RestartPoint(number, state, span)


def adaptive_jumps(
    cycles: Cycles, stops: Iterable[int], restart: RestartPoint, tolerance: float, longest: float
) -> Iterator[Increment]:
    """Compute all cycles in jumps with an error within the tolerance.

    Parameters
    ----------
    cycles : Cycles
    stops : iterable of int
        Cycles that no jump passes over, in order, including the last one.
    restart : RestartPoint
    tolerance : float
        Error relative to the largest worn depth.
    longest : float
        Largest number of cycles of a jump.

    Yields
    ------
    Increment
        Increments of the cycles of accepted jumps; rejected jumps yield nothing.

    Raises
    ------
    ComputationError
        If a single cycle fails.
    """
    for stop in stops:
        while restart.cycle < stop:
            span = _at_most(min(restart.following, longest), stop - restart.cycle)
            wanted = restart.following
            for increment in _jumped(cycles, restart, span, tolerance):
                if increment.jump is not None and increment.segment.cycle == stop:
                    following = max(increment.jump.following, wanted)
                    jump = replace(increment.jump, following=following)
                    increment = replace(increment, jump=jump)
                yield increment
            assert increment.restart is not None  # it ends the jump
            restart = increment.restart


def _at_most(wanted: float, left: int) -> int:
    """Whole number of cycles, chosen so that no short remainder is left."""
    return left if wanted >= left else max(1, int(min(wanted, math.ceil(left / 2))))


def _jumped(
    cycles: Cycles, restart: RestartPoint, wanted: int, tolerance: float
) -> Iterable[Increment]:
    """Increments of one jump, which is halved until its error is within the tolerance."""
    start, state, span, whole = restart.cycle, restart.state, wanted, None
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
        two_parts = _TwoPartJump(n1, n2, state, whole[-1].state, second[-1])
        error = two_parts.error
        if error <= tolerance:
            jump = Jump(span, error, span * _growth(error, tolerance))
            return [*first, *second[:-1], replace(two_parts.corrected(cycles), jump=jump)]
        span, whole = n1, first  # the whole of the next attempt
    jump = Jump(1, 0.0, restart.following if wanted == 1 else 2.0)
    return (_marked(increment, jump) for increment in cycles.cycle(state, start + 1, 1))


@dataclass(frozen=True)
class _TwoPartJump:
    """Jump computed in two parts and as a whole, with the symbols of the module's docstring.

    Attributes
    ----------
    n1, n2 : int
    start, whole : StickSlipState
        States before the jump, and after it as a whole.
    end : Increment
        End of the second part.
    """

    n1: int
    n2: int
    start: StickSlipState
    whole: StickSlipState
    end: Increment

    @property
    def part(self) -> float:
        """Error of the two parts as a fraction of their difference from the whole."""
        single = self.n1 * (self.n1 - 1) + self.n2 * (self.n2 - 1)
        return single / (2 * self.n1 * self.n2)

    @property
    def excess(self) -> np.ndarray:
        """Excess depth after the two parts, shape (n_wearing, m) [m]."""
        return self.part * (self.whole.worn - self.end.state.worn)

    @property
    def error(self) -> float:
        """Largest excess depth relative to the largest depth; 0 without wear.

        Coefficients across the stick edge do not count: when it passes from one to the next, their
        depths change at once, however short the jump. `FrettingState.edge_error` estimates that.
        """
        largest = float(self.end.state.worn.max(initial=0.0))
        if largest == 0.0:
            return 0.0
        each = (self.start.crossed, self.whole.crossed, self.end.state.crossed)
        across = np.any(each, axis=0)
        excess = self.excess[:, ~across] if across.any() else self.excess
        return float(np.abs(excess).max(initial=0.0)) / largest

    def corrected(self, cycles: Cycles) -> Increment:
        """End of the second part with the estimated error subtracted."""
        if self.part == 0.0:
            return self.end
        start, whole, state, part = self.start, self.whole, self.end.state, self.part
        worn = start.worn + _nonnegative(state.worn - self.excess - start.worn, cycles.areas)
        dissipated = state.dissipated - part * (whole.dissipated - state.dissipated)
        spared = state.spared - part * (whole.spared - state.spared)
        outside = np.all([one.part < 1.0 for one in (start, whole, state)], axis=0)
        excess = state.excess - np.where(outside, part * (whole.excess - state.excess), 0.0)
        excess = np.maximum(excess, 0.0)
        settled = replace(state, worn=worn, spared=spared, excess=excess)
        found = cycles.equilibrium(self.end, settled)
        found = replace(found, dissipated=dissipated, status=state.status)
        return replace(self.end, state=found)


def _growth(error: float, tolerance: float) -> float:
    """Size factor for the next jump; the error is quadratic in the number of cycles."""
    if error == 0.0:
        return _LONGER
    return float(np.clip(_SAFETY * math.sqrt(tolerance / error), _SHORTER, _LONGER))


def _nonnegative(gains: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """Depth gains (n_wearing, m) with negative values clipped and the others scaled down.

    Volumes are preserved, so that they remain consistent with the dissipated energy.
    """
    kept = np.maximum(gains, 0.0)
    volumes = np.where(kept.any(axis=1), kept @ areas, 1.0)
    return kept * np.maximum(gains @ areas / volumes, 0.0)[:, None]


def _marked(increment: Increment, jump: Jump) -> Increment:
    """Increment with the jump attached if it ends a cycle."""
    ends = increment.ends_segment and increment.segment.ends_cycle
    return replace(increment, jump=jump) if ends else increment
