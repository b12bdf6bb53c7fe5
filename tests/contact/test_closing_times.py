"""Times at which the edge of the wear reaches points."""

import numpy as np
import pytest

from thermowear.contact.wear.wear_edge import closing_times


def gap(time, closing, bend):
    """One that closes at a time, at a speed of one there [m]."""
    left = np.maximum(closing - time, 0.0)
    return left + bend * left**2


@pytest.mark.parametrize("bend", [0.0, 0.05, -0.02])
def test_gaps_that_close_later_are_followed_by_a_parabola(bend):
    """requirement: the end of a step is chosen by it; slower and faster closing, to rounding."""
    found = closing_times(*(gap(np.array([t]), 7.0, bend) for t in (0.0, 1.5, 3.0)), 3.0)
    assert found == pytest.approx([7.0], rel=1e-12)


def test_gaps_that_have_closed_in_the_second_half_are_found_within_the_step():
    found = closing_times(*(gap(np.array([t]), 1.9, 0.0) for t in (0.0, 1.5, 3.0)), 3.0)
    assert found == pytest.approx([1.9], rel=1e-12)


def test_others_do_not_close():
    """requirement: opening, closed before, unknown: infinite, and no warning."""
    start, middle, end = np.array(
        [[1.0, 1.0, np.nan, 0.0], [2.0, 0.0, 0.5, 0.0], [3.0, 0.0, 0.2, 0.0]]
    )
    assert np.all(np.isinf(closing_times(start, middle, end, 1.0)))


def test_a_gap_that_turns_before_it_closes_ends_a_step_where_it_is_smallest():
    times = np.array([0.0, 1.0, 2.0])
    found = closing_times(*(1.0 + (times[:, None] - 5.0) ** 2), 2.0)
    assert 2.0 < found[0] < np.inf
