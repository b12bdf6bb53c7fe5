"""Sizes of steps between times that are hit exactly."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from thermowear.model.analyses import TransientAnalysis
from thermowear.simulation import time_loop
from thermowear.simulation.time_loop import (
    AnySize,
    FewSizes,
    ends,
    moments,
    next_step,
    times_to_hit,
)


def walk(sizes, times, wanted, time=0.0, begin=0.0):
    """Steps that a run takes which would like such a step at a time."""
    steps = []
    for end in times:
        while time < end:
            begin = sizes.begin(time, begin, end)
            step = sizes.at_most(wanted(time), time, begin, end)
            assert 0 < step <= wanted(time) * (1 + 1e-9)
            steps.append(step)
            time = end if ends(step, end - time, end) else time + step
            assert time <= end
            assert len(steps) < 5000
        begin = end
    return steps


def growing(time):
    return 1e-4 + 0.3 * time


@pytest.mark.parametrize(
    "times", [(0.1, 1.0, 10.0, 100.0), (0.5, 1.0, 2.0, 4.0, 60.0), (1.0, 6.0, 7.0, 20.0, 21.0)]
)
def test_round_times_share_their_sizes(times):
    """requirement: powers of two of one size, one for each doubling of the steps."""
    steps = walk(FewSizes(times), times, growing)
    sizes = set(steps)
    powers = sorted(math.log2(size / min(sizes)) for size in sizes)
    assert powers == pytest.approx(list(range(len(sizes))), abs=1e-9)
    assert len(steps) < 80


def test_odd_times_have_sizes_of_their_own():
    """requirement: a common measure that is too small for any step to need it is not used."""
    times = (1.0, 2.7182818)
    steps = walk(FewSizes(times), times, growing)
    assert min(steps) > 1e-5
    assert len(steps) < 60


@pytest.mark.parametrize("seed", range(200))
def test_any_times_are_hit(seed):
    """
    requirement: random times to the millisecond, in minutes, or any: all are hit by steps hardly
    more than with one end, of few sizes for each interval; so from any of them on.
    """
    random = np.random.default_rng(seed)
    end, count = 10 ** random.uniform(-1, 4), random.integers(1, 8)
    rounded = [lambda t: np.round(t, 3), lambda t: np.round(t / 60, 2) * 60, lambda t: t]
    times = np.unique(rounded[seed % 3](random.uniform(0.2, 1, count) * end))
    times = [float(t) for t in times if t > 0] or [0.737]
    sizes = FewSizes(times)
    steps = walk(sizes, times, growing)
    alone = walk(FewSizes(times[-1:]), times[-1:], growing)
    assert len(steps) <= 2 * len(alone) + 8 * len(times)
    assert len(set(steps)) <= len(set(alone)) + 8 * len(times)
    start = random.uniform(0, 1) * times[0]  # of a run that is continued with other times
    for begin in (0.0, start):
        assert len(walk(FewSizes(times), times, growing, start, begin)) <= len(steps) + 50
    assert sizes.begin(steps[0], 0.0, times[0]) == 0.0


def test_times_to_the_millisecond_share_their_sizes():
    """requirement: the largest common measure, to the last bits, by which all steps are made."""
    for unit, times in (
        (0.1, (0.1, 0.2, 0.30000000000000004, 4.0)),
        (0.001, (0.736, 2.0)),
        (0.713, (0.713, 0.713 + 0.713, 3 * 0.713)),
    ):
        sizes = set(walk(FewSizes(times), times, lambda time: 0.1))
        powers = np.log2(sorted(sizes)) - np.log2(unit)
        np.testing.assert_allclose(powers, np.round(powers), rtol=0.0, atol=1e-9)


def test_times_that_rounding_tells_apart_are_one():
    """requirement: an output time and a kink, an end and the last of many periods."""
    settings = TransientAnalysis(end_time=0.9, output_times=(0.3, 0.6), tolerance=1e-3)
    problem = SimpleNamespace(corners=lambda end: (0.1 + 0.2, 0.1 * 3 * 2, 0.7, 0.3 * 3))
    assert times_to_hit(settings, problem) == [0.3, 0.6, 0.7, 0.9]


def test_few_steps_are_added():
    """requirement: steps are hardly smaller than they may be."""
    steps = walk(FewSizes((15.0, 30.0)), (15.0, 30.0), lambda time: 1.0)
    assert steps == [15 / 16] * 32
    # 26 s in steps of at most 10 s
    assert walk(FewSizes((4.0, 30.0)), (4.0, 30.0), lambda time: 10.0) == [4.0, 8.0, 8.0, 8.0, 2.0]


def test_smaller_steps_go_on_from_where_they_are():
    """requirement: after a small step, larger ones wait until they hit the end again."""
    sizes = FewSizes((8.0,))
    assert sizes.at_most(8.0, 1.0, 0.0, 8.0) == 1.0
    assert sizes.at_most(8.0, 2.0, 0.0, 8.0) == 2.0
    assert sizes.at_most(8.0, 4.0, 0.0, 8.0) == 4.0
    assert sizes.at_most(0.3, 4.0, 0.0, 8.0) == 0.25


def test_without_an_end():
    assert FewSizes((math.inf,)).at_most(0.7, 0.0, 0.0, math.inf) == 0.5


def test_any_size_leaves_no_tiny_step():
    """requirement: the last two steps are alike."""
    steps = walk(AnySize(), (1.0,), lambda time: 0.3125)
    assert sum(steps) == pytest.approx(1.0)
    assert min(steps) > 0.15
    assert max(steps) == 0.3125


@pytest.mark.parametrize("wanted", [1e-12, 0.3, 0.7313, 1.0, 5e7])
def test_rounding_does_not_reach_the_sizes(wanted):
    """requirement: sizes that differ by rounding are one, hardly smaller; whole bounds are kept."""
    sizes = AnySize()
    given = wanted * (1 + 1e-10 * np.linspace(1, 2, 20))
    (size,) = {sizes.at_most(one, 0.0, 0.0, math.inf) for one in given}
    assert wanted / sizes.rounding < size <= given[0]
    assert AnySize(0.3).at_most(wanted, 0.0, 0.0, math.inf) == min(0.3, size)
    assert sizes.at_most(math.inf, 0.0, 0.0, 2.0) == 2.0


@pytest.mark.parametrize("times", [(0.1, 1.0, 10.0), (1.0, 2.7182818, 4.0), (1.0, 6.0, 7.0, 20.0)])
def test_given_steps_have_the_sizes_of_the_run(times, monkeypatch):
    """
    requirement: to the last bit, so that the operators of one size serve them; at the targets, the
    states are outputs.
    """
    sizes, taken = walk(FewSizes(times), times, growing), []
    stops, targets, time = [], list(times), 0.0
    for size in sizes:
        time = targets.pop(0) if ends(size, targets[0] - time) else time + size
        stops.append(time)

    def advance(problem, state, time, step):
        taken.append(step)
        return state

    monkeypatch.setattr(time_loop, "advance_without_error", advance)
    problem = SimpleNamespace(
        start=lambda: None,
        distance=lambda state, steady: math.nan,
        first_step=lambda state: 1.0,
        corners=lambda end: (),
    )
    settings = TransientAnalysis(
        end_time=times[-1], output_times=times[:-1], steps=tuple(stops), tolerance=1e-3
    )
    found = list(moments(problem, settings, None, FewSizes(times)))[1:]
    assert taken == sizes
    assert [one.time for one in found] == stops
    assert [one.time for one in found if one.is_output] == list(times[:-1])
    assert len(set(sizes)) < len(sizes)


def test_next_step_of_an_error_of_third_order():
    """requirement: for an error c h³ the next step has 0.9³ of the tolerance, within 0.2 to 5."""
    for step in (0.3, 1.0, 2.0):
        following = next_step(step, 4.0 * step**3, 1.0)
        assert 4.0 * following**3 == pytest.approx(0.9**3)
    assert next_step(1.0, 1e9, 1.0) == 0.2
    assert next_step(1.0, 1e-9, 1.0) == next_step(1.0, 0.0, 1.0) == 5.0
    assert next_step(1.0, 0.0, 1.0, wanted=8.0) == 8.0  # has been cut short
    assert next_step(1.0, 1.0, 1.0, wanted=8.0) == 0.9


def test_next_step_of_a_decaying_transient():
    """
    requirement: errors that grow by a slower power of the steps are extrapolated (Gustafsson);
    steps are not reduced by that, nor are those that are too large.
    """
    former, step = (1.0, 0.1), (2.0, 0.1)  # twice the step, the same error
    assert next_step(*step, 0.2, former) == pytest.approx(2.0 * next_step(*step, 0.2))
    assert next_step(*step, 0.2, (1.0, 1e-9)) == next_step(*step, 0.2)
    assert next_step(*step, 0.05, former) == next_step(*step, 0.05)
