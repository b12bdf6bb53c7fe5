"""The way through a history of loads and the repetitions of its cycle."""

from dataclasses import replace

from thermowear.case.tables.tabulated import History
from thermowear.laws.histories import LoadHistories
from thermowear.simulation.cycles.load_path import LoadPath


def of(given: History) -> LoadHistories:
    return LoadHistories((given.loads,))


def history(*pushes, **keys):
    times = [f"{t} s" for t in range(len(pushes))]
    return of(History(time=times, tangential_force=[f"{q} N" for q in pushes], **keys))


SHORT = History(time=["0 s", "0.1 s", "0.2 s"], tangential_force=["0 N", "1 N", "0 N"])


def way(loads, cycles=1, jump=1, output_times=()):
    path = LoadPath(loads, output_times)
    legs, before = list(path.first_pass()), 0
    if loads.cycle is None:
        return legs
    for number in path.jumped_cycles(cycles, jump):
        legs += path.cycle(number, number - before)
        before = number
    return legs


def ends(loads, **settings):
    return [(leg.end, leg.cycle, leg.repeats) for leg in way(loads, **settings)]


def stops(loads, cycles, *output_times):
    return LoadPath(loads, output_times).cycles_to_stop_at(cycles)


LOOP = history(0, 36, -36, 36)


def test_the_first_leg_has_no_duration():
    """requirement: the bodies are loaded at the first instant."""
    first, second, *_ = way(LOOP)
    assert (first.start, first.end, first.instant, first.cycle) == (0.0, 0.0, 0.0, 0)
    assert (second.start, second.end) == (0.0, 1.0)


def test_a_cycle_begins_where_the_loads_are_those_of_the_end():
    """requirement: the first such instant by default; another one where it is given."""
    assert LOOP.cycle == (1.0, 3.0)
    assert history(0, 36, -36, 0).cycle == (0.0, 3.0)
    again = history(36, 0, 36, -36, 36)
    assert again.cycle == (0.0, 4.0)
    later = LoadHistories((replace(again.each[0], cycle_start=2.0),))
    assert later.cycle == (2.0, 4.0)
    assert history(0, 1, 2).cycle is None
    between = history(36, -36, 36, cycle_start="0 s")
    assert between.cycle == (0.0, 2.0)


def test_cycles_follow_one_another():
    """requirement: time goes on, the loads come back, cycles are counted from one."""
    found = way(LOOP, cycles=3)
    assert [leg.end for leg in found] == [0, 1, 2, 3, 4, 5, 6, 7]
    assert [leg.instant for leg in found] == [0, 1, 2, 3, 2, 3, 2, 3]
    assert [leg.cycle for leg in found] == [0, 0, 1, 1, 2, 2, 3, 3]
    assert [leg.ends_cycle for leg in found] == [False, False] + [False, True] * 3
    assert all(leg.repeats == 1 and not leg.is_output for leg in found)
    assert [leg.start for leg in found[1:]] == [leg.end for leg in found[:-1]]


def test_without_a_cycle_the_history_is_followed_once():
    """requirement: any history can be followed."""
    assert ends(history(0, 1, 2)) == [(0, 0, 1), (1, 0, 1), (2, 0, 1)]


def test_of_jumped_cycles_the_last_is_computed():
    """requirement: it stands for all of them, also for what is left over at the end; the first one
    stands for itself.
    """
    assert ends(LOOP, cycles=8, jump=3)[2:] == [
        *((2.0, 1, 1), (3.0, 1, 1)),
        *((6.0, 3, 2), (7.0, 3, 2)),
        *((12.0, 6, 3), (13.0, 6, 3)),
        *((16.0, 8, 2), (17.0, 8, 2)),
    ]
    assert sum(leg.repeats for leg in way(LOOP, cycles=1000, jump=77) if leg.ends_cycle) == 1000


def test_output_times_are_hit():
    """requirement: in the first pass, in later cycles, at ends of cycles; no cycle is invented."""
    found = way(LOOP, cycles=10, jump=5, output_times=(0.5, 1.0, 4.25, 9.0))
    outputs = [(leg.end, leg.instant, leg.cycle) for leg in found if leg.is_output]
    assert outputs == [(0.5, 0.5, 0), (1.0, 1.0, 0), (4.25, 2.25, 2), (9.0, 3.0, 4)]
    computed = [(leg.cycle, leg.repeats) for leg in found if leg.ends_cycle]
    assert computed == [(1, 1), (2, 1), (4, 2), (5, 1), (10, 5)]


def test_no_jump_passes_an_output_time():
    """requirement: adaptive jumps end before a cycle that is left on its way, and at its end."""
    assert stops(LOOP, 10) == [1, 10]
    assert stops(LOOP, 10, 0.5, 1.0) == [1, 10]  # before the first cycle
    assert stops(LOOP, 10, 2.0, 9.0) == [1, 4, 10]
    assert stops(LOOP, 10, 4.25, 12.5) == [1, 2, 5, 6, 10]
    short = of(SHORT)
    for count in range(2, 51):
        assert stops(short, 60, count / 5) == [1, count, 60]


def test_ends_of_cycles_are_found_in_spite_of_rounding():
    """requirement: an output at the end of a cycle of tenths of seconds is no leg of its own."""
    short = of(SHORT)
    for count in range(1, 51):
        found = way(short, cycles=25, output_times=(count / 10,))
        assert len(found) == 1 + 25 * 2
        assert [leg.end for leg in found if leg.is_output] == [count / 10]
        assert all(leg.end - leg.start > 0.09 for leg in found[1:])


def test_a_cycle_may_begin_between_corners():
    """requirement: it has a corner there, in the first pass."""
    loads = history(0, 2, -2, 2, cycle_start="1 s")
    assert ends(loads, cycles=2) == [
        (0, 0, 1), (1, 0, 1), (2, 1, 1), (3, 1, 1), (4, 2, 1), (5, 2, 1),
    ]  # fmt: skip
    ramp = of(
        History(
            time=["0 s", "2 s", "3 s", "4 s"],
            tangential_force=["0 N", "2 N", "0 N", "1 N"],
            cycle_start="1 s",
        )
    )
    assert [leg.end for leg in way(ramp)] == [0, 1, 2, 3, 4]


def test_several_histories_have_one_cycle():
    """requirement: corners of all; a shorter one stays where it ends; one cycle, closed for all."""
    press = History(time=["0 s", "1.5 s"], force=["1 N", "2 N"])
    pull = History(
        time=["0 s", "1 s", "2 s", "3 s", "4 s"],
        tangential_force=["0 N", "1 N", "0 N", "-1 N", "1 N"],
    )
    both = LoadHistories((press.loads, pull.loads))
    assert both.time == (0.0, 1.0, 1.5, 2.0, 3.0, 4.0)
    assert LoadHistories((pull.loads,)).cycle == (1.0, 4.0)
    assert both.cycle is None  # the force of 1 s is not that of the end
    early = History(time=["0 s", "0.5 s"], force=["1 N", "2 N"])
    both = LoadHistories((early.loads, pull.loads))
    assert both.cycle == (1.0, 4.0)
    assert [leg.end for leg in way(both, cycles=2)] == [0, 0.5, 1, 2, 3, 4, 5, 6, 7]
    assert both.end(3) == 10.0
