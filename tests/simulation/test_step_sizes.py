"""Sizes of steps between times that are hit exactly."""

import math

import pytest

from thermowear.simulation.time.time_loop import AnySize, FewSizes, ends


def walk(sizes, times, wanted):
    """Steps that a run takes which would like such a step at a time."""
    time, begin, steps = 0.0, 0.0, []
    for end in times:
        while time < end:
            step = sizes.at_most(wanted(time), time, begin, end)
            assert 0 < step <= wanted(time) * (1 + 1e-9)
            steps.append(step)
            time = end if ends(step, end - time) else time + step
            assert time <= end
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
    steps = walk(AnySize(), (1.0,), lambda time: 0.3)
    assert sum(steps) == pytest.approx(1.0)
    assert min(steps) > 0.15
    assert max(steps) == 0.3
