"""Jumps over cycles, on cycles that are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermowear.contact.friction.gross_slip import FullSliding
from thermowear.contact.friction.stick_slip_state import StickSlipState
from thermowear.errors import ComputationError
from thermowear.simulation.cycles.load_path import (
    Increment,
    LoadSegment,
    RestartPoint,
    adaptive_jumps,
    fixed_jumps,
)

RATES = np.array([[1.0, 3.0, 0.0]])
AREAS = np.array([1.0, 2.0, 1.0])
COUNT = 3000


class Growing:
    """Cycles that wear less the more has been worn: W' = r/(1 + W), W = sqrt(1 + 2 r n) - 1."""

    areas = AREAS

    def __init__(self, most=COUNT):
        self.computed = []  # numbers and repeats
        self.settled_at = []
        self._most = most  # repeats

    def start(self):
        nothing = np.zeros((1, 3))
        return RestartPoint(0, state_of(nothing))

    def rate(self, worn, repeats):
        return RATES / (1 + worn)

    def cycle(self, state, number, repeats):
        if repeats > self._most:
            raise ComputationError("too far")
        self.computed.append((number, repeats))
        for half in (1, 2):
            gained = repeats / 2 * self.rate(state.worn, repeats)
            lost = state.dissipated + (gained * AREAS)[0]
            state = replace(state, worn=state.worn + gained, dissipated=lost)
            segment = LoadSegment(
                number - 1.5 + half / 2, number - 1 + half / 2, 0, number, repeats, False, half == 2
            )
            yield Increment(segment.end, segment, True, state)

    def equilibrium(self, end, state):
        self.settled_at.append(end.segment.cycle)
        return replace(state, dissipated=np.full(3, np.nan))


def state_of(worn):
    nothing, none = np.zeros(3), np.zeros((3, 1))
    loads, edge = (none[0], none[0]), (nothing,) * 6
    return StickSlipState(nothing, none, none, *loads, nothing, none, nothing, worn, *edge)


def run(cycles, tolerance=1e-2, stops=(1, COUNT), longest=np.inf, restart=None):
    return list(adaptive_jumps(cycles, stops, restart or cycles.start(), tolerance, longest))


def turns(increments):
    return [increment for increment in increments if increment.jump is not None]


def one_by_one(count=COUNT):
    cycles = Growing()
    *_, last = fixed_jumps(cycles, range(1, count + 1), cycles.start())
    return last.state


def error(increments):
    known = one_by_one().worn
    return np.abs(increments[-1].state.worn - known).max() / known.max()


def test_jumps_are_long_and_good():
    """requirement: few cycles are computed, and the end is that of all of them."""
    cycles = Growing()
    found = run(cycles)
    assert len(cycles.computed) < 150
    assert error(found) < 2e-3
    sizes = [increment.jump.cycles for increment in turns(found)]
    assert sizes[0] == 1
    assert sizes[-1] > 100


def test_the_tolerance_controls_the_error():
    """requirement: second order, so that the error goes with the tolerance."""
    coarse, middle, fine = (error(run(Growing(), tolerance)) for tolerance in (2e-2, 5e-3, 1.25e-3))
    assert fine < middle / 2.5 < coarse / 6
    assert coarse < 5e-3


class Crossed(Growing):
    """The stick edge crosses the third coefficient, which wears fast from some time on."""

    def cycle(self, state, number, repeats):
        for increment in super().cycle(state, number, repeats):
            of_edge = np.array([0.0, 0.0, 0.5])
            worn = increment.state.worn + (increment.state.worn[:, :1] > 20.0) * [0.0, 0.0, 5.0]
            yield replace(increment, state=replace(increment.state, part=of_edge, worn=worn))


def test_the_stick_edge_does_not_shorten_jumps():
    """requirement: depths of what it crosses change at once, however short a jump is."""
    cycles = Crossed()
    found = run(cycles)
    assert len(cycles.computed) < 150
    inside = (slice(None), slice(0, 2))
    known = one_by_one().worn[inside]
    assert np.abs(found[-1].state.worn[inside] - known).max() / known.max() < 2e-3


def test_the_estimate_is_that_of_the_halves():
    """requirement: what is reported is the error of the parts of a jump before it is taken out."""
    for start, span in ((20, 10), (200, 100), (30, 7)):
        cycles = Growing()
        state = one_by_one(start)
        restart = RestartPoint(start, state, span)
        (turn,) = turns(run(cycles, 0.1, (start + span,), restart=restart))
        assert turn.jump.cycles == span
        n1 = span - span // 2
        first = list(cycles.cycle(state, start + n1, n1))[-1].state
        halves = list(cycles.cycle(first, start + span, span - n1))[-1].state.worn
        exact = one_by_one(start + span).worn
        assert turn.jump.error * halves.max() == pytest.approx(
            np.abs(halves - exact).max(), rel=0.35
        )
        assert np.abs(turn.state.worn - exact).max() < 0.35 * np.abs(halves - exact).max()


def test_pairs_of_cycles_are_exact():
    """requirement: where no error is allowed each cycle is computed, and nothing is corrected."""
    cycles = Growing()
    found = run(cycles, 1e-15, (1, 30))
    assert {increment.jump.cycles for increment in turns(found)} <= {1, 2}
    assert all(increment.jump.error == 0.0 for increment in turns(found))
    assert not cycles.settled_at
    np.testing.assert_array_equal(found[-1].state.worn, one_by_one(30).worn)


@pytest.mark.parametrize("longest", [1, 2, 37, 500])
def test_no_jump_is_longer_than_allowed(longest):
    """requirement: the largest jump, and nothing else, is bounded by it."""
    found = run(Growing(), longest=longest)
    sizes = [increment.jump.cycles for increment in turns(found)]
    assert max(sizes) <= longest
    assert sum(sizes) == COUNT
    assert error(found) < 2e-3


def test_all_stops_are_hit():
    """requirement: exact totals, no jump across a stop, none that leaves a few cycles over."""
    stops = (1, 2, 999, 1000, 1777, COUNT)
    found = turns(run(Growing(), stops=stops))
    numbers = [increment.segment.cycle for increment in found]
    assert set(stops) <= set(numbers)
    assert numbers == list(np.cumsum([increment.jump.cycles for increment in found]))
    after = found[numbers.index(1000) + 1]
    assert after.jump.cycles > 50  # a short jump to a stop does not shorten the next one


def test_what_was_too_long_leaves_no_trace():
    """requirement: numbers and energies only grow; rejected jumps are not among the increments."""
    cycles = Growing()
    found = run(cycles, 1e-4)
    numbers = [increment.segment.cycle for increment in found]
    assert numbers == sorted(numbers)
    assert np.all(np.diff([increment.state.dissipated.sum() for increment in found]) > 0)
    assert len(found) < 2 * len(cycles.computed)


def test_volumes_stay_those_of_the_energy():
    """requirement: what is taken out of the depths is taken out of the energy too."""
    for increment in turns(run(Growing())):
        volume, lost = (increment.state.worn @ AREAS)[0], increment.state.dissipated.sum()
        assert volume == pytest.approx(lost, rel=1e-12)


class Widening(Growing):
    """An edge that only long jumps reach: the middle alone wears in single cycles."""

    def rate(self, worn, repeats):
        return np.array([[1.0, 3.0, 0.05 * (repeats - 1)]])


def test_wear_never_goes_back():
    """requirement: no depth shrinks where a long jump wears what shorter ones do not reach."""
    cycles = Widening()
    found = turns(run(cycles, 0.1, (1, 200)))
    worn = np.array([increment.state.worn[0] for increment in found])
    assert np.all(np.diff(worn, axis=0) >= 0)
    assert cycles.settled_at
    for increment in found:
        volume, lost = (increment.state.worn @ AREAS)[0], increment.state.dissipated.sum()
        assert volume == pytest.approx(lost, rel=1e-12)


def test_jumps_that_cannot_be_computed_are_halved():
    """requirement: a failing cycle that stands for many is no end of the run."""
    found = run(Growing(most=20))
    assert max(increment.jump.cycles for increment in turns(found)) <= 20
    assert error(found) < 2e-3
    singles = turns(run(Growing(most=1), stops=(1, 9)))
    assert [increment.jump.cycles for increment in singles] == [1] * 9
    with pytest.raises(ComputationError):
        run(Growing(most=0))


def test_sliding_is_no_matter_of_jumps():
    """requirement: more force than friction carries is reported at once."""

    class Sliding(Growing):
        def cycle(self, state, number, repeats):
            if number > 10:
                self.computed.append((number, repeats))
                raise FullSliding("slides")
            yield from super().cycle(state, number, repeats)

    cycles = Sliding()
    with pytest.raises(FullSliding):
        run(cycles)
    assert sum(number > 10 for number, _ in cycles.computed) == 1


@pytest.mark.parametrize("after", [1, 5, 12])
def test_a_run_goes_on_as_if_it_had_not_stopped(after):
    """requirement: the end of a jump holds all that the next one takes."""
    stops = (1, 500, COUNT)
    straight = turns(run(Growing(), stops=stops))
    resumed = turns(run(Growing(), stops=stops, restart=straight[after].restart))
    assert [i.segment.cycle for i in straight[after + 1 :]] == [i.segment.cycle for i in resumed]
    np.testing.assert_array_equal(straight[-1].state.worn, resumed[-1].state.worn)


def test_fixed_jumps_have_no_estimate():
    """requirement: cycles of given numbers, each for all since the one before."""
    cycles = Growing()
    found = turns(fixed_jumps(cycles, (1, 5, 9), cycles.start()))
    assert cycles.computed == [(1, 1), (5, 4), (9, 4)]
    assert [increment.jump.cycles for increment in found] == [1, 4, 4]
    assert all(np.isnan(increment.jump.error) for increment in found)
