"""Loads and speeds that change in time."""

from __future__ import annotations

from itertools import pairwise

import pytest

import thermowear as tw

from .bad import Bad, assert_refused
from .starter import FRETTING, GONE, HERTZ, RECIPROCATING, RUNNING_IN, STEADY, tables

LOAD, SPEED, FRICTION = "load.history", "motion.history", "contact.friction_history"
STOP = {"time": ["0 s", "10 s"], "factor": [1, 0]}
DUTY = {"time": ["1 s", "3 s", "4 s", "5 s"], "factor": [1, 1, 0, 1], "repeat": True}
PRESS = {"time": ["0 s", "1 s", "4 s"], "force": ["0 N", "2 kN", "1 kN"]}
BEAM, PIVOT, STRIP = "beam-on-foundation", "pivoted-block", "punch-on-strip"
IN_TIME = {"analysis": {"type": "transient", "end_time": "10 s"}}


def pressed(**more) -> dict:
    """A force that changes, and nothing beside it."""
    return {"load": {"history": PRESS | more}}


BAD = [
    Bad("time goes back", {SPEED: STOP | {"time": ["1 s", "0 s"]}}, f"{SPEED}.time", "increase",
        RUNNING_IN),
    Bad("empty", {SPEED: {"time": [], "factor": []}}, f"{SPEED}.time", "is empty", RUNNING_IN),
    Bad("lists that differ", {SPEED: STOP | {"factor": [1]}}, f"{SPEED}.factor",
        "has 1 values for 2 times", RUNNING_IN),
    Bad("back", {SPEED: STOP | {"factor": [1, -1]}}, f"{SPEED}.factor.1", "at least", RUNNING_IN),
    Bad("never moves", {SPEED: STOP | {"factor": [0, 0]}}, f"{SPEED}.factor", "greater",
        RUNNING_IN),
    Bad("jumps back", {SPEED: STOP | {"repeat": True}}, f"{SPEED}.repeat",
        "the last value of factor must equal the first one", RUNNING_IN),
    Bad("repeats an instant", {SPEED: {"time": ["0 s"], "factor": [1], "repeat": True}},
        f"{SPEED}.repeat", "at least two instants", RUNNING_IN),
    Bad("repeats, 1", {SPEED: STOP | {"repeat": 1}}, f"{SPEED}.repeat", "true or", RUNNING_IN),
    Bad("steady speed that changes", {SPEED: STOP}, SPEED, "transient analysis, not steady"),
    Bad("strokes that change", {SPEED: STOP}, SPEED, "not reciprocating", RECIPROCATING),
    Bad("until steady", {SPEED: STOP, "analysis": {"type": "transient", "until": "steady"}},
        "analysis.until", "is not supported under motion.history", RUNNING_IN),
    Bad("until steady, pressed", pressed() | {"analysis.until": "steady"},
        "analysis.until", "is not supported under load.history", RUNNING_IN),
    Bad("steady load that changes", pressed(), LOAD, "not steady"),
    Bad("strokes under a load that changes", pressed(), LOAD, "not recip", RECIPROCATING),
    Bad("initial load that changes", pressed(), LOAD, "transient or fretting analysis, not", HERTZ),
    Bad("force twice", {LOAD: PRESS}, "load", "already prescribes the force", RUNNING_IN),
    Bad("nothing presses", pressed(force=["0 N"] * 3), f"{LOAD}.force", "greater", RUNNING_IN),
    Bad("pull", pressed(force=["1 N", "1 N", "-1 N"]), f"{LOAD}.force.2", "at least", RUNNING_IN),
    Bad("approach in time", {"load": {"history": {"time": ["0 s"], "approach": ["1 um"]}}},
        f"{LOAD}.approach", "requires a fretting analysis", RUNNING_IN),
    Bad("pushed across in time", pressed(tangential_force=["1 N"] * 3),
        f"{LOAD}.tangential_force", "a transient one supports force only", RUNNING_IN),
    Bad("history of nothing", {LOAD: {"time": ["0 s"]}}, f"{LOAD}.force", "missing", RUNNING_IN),
    Bad("cycle of a running-in", pressed(force=["1 N"] * 3, cycle_start="1 s"),
        f"{LOAD}.cycle_start", "use repeat = true", RUNNING_IN),
    Bad("load that jumps back", pressed(repeat=True), f"{LOAD}.repeat",
        "the last value of force must", RUNNING_IN),
    Bad("fretting again and again",
        {f"{LOAD}.repeat": True, f"{LOAD}.tangential_force": ["36 N", "0 N", "-36 N", "36 N"]},
        f"{LOAD}.repeat", "use analysis.cycles in a fretting analysis", FRETTING),
    Bad("moment beside it", IN_TIME | {"load": {"history": PRESS, "moment": "1 N m"}},
        "load.moment", "cannot be combined with load.history", PIVOT),
    Bad("pulled beside it",
        IN_TIME | {"load": {"history": PRESS, "tangential_force": "1 N"},
        "holder.free": ["z", "x"]},
        "load.tangential_force", "cannot be combined with load.history", STRIP),
    Bad("fixed beside it", {"load.history": PRESS}, "load.surfaces",
        "cannot be combined with load.history", BEAM),
    Bad("steady friction that changes", {FRICTION: STOP}, FRICTION, "not steady"),
    Bad("friction of strokes", {FRICTION: STOP}, FRICTION, "not reciprocating", RECIPROCATING),
    Bad("friction of fretting", {FRICTION: STOP}, FRICTION, "not fretting", FRETTING),
    Bad("friction of nothing", {FRICTION: STOP, "contact.friction": 0.0,
        "wear.punch.per": "pressure"}, FRICTION, "contact.friction is 0", RUNNING_IN),
    Bad("until steady under friction", {FRICTION: STOP, "analysis":
        {"type": "transient", "until": "steady"}}, "analysis.until", f"under {FRICTION}",
        RUNNING_IN),
    Bad("friction by penalty", {FRICTION: STOP, "contact.method": "penalty"}, "contact.method",
        "not support variable friction", RUNNING_IN),
    Bad("fixed and pressed", pressed(), LOAD, "the holder is fixed", BEAM),
]  # fmt: skip


@pytest.mark.parametrize("bad", BAD, ids=lambda bad: bad.name)
def test_a_fault_of_a_history_is_one_line_with_the_path_of_its_key(bad, tmp_path, capsys):
    """
    requirement: bad input ends with exit code 1 and one line: exact path, what is wrong with it.
    """
    assert_refused(bad, tmp_path, capsys)


def test_a_stop_is_a_straight_line_and_stands_still_after_it():
    """
    requirement: braking stops: the speed by straight lines, constant after the last instant.
    """
    history = tw.load(tables(RUNNING_IN, {SPEED: STOP})).motion.history.function
    assert [history.at(t) for t in (0.0, 2.5, 10.0, 99.0)] == pytest.approx([1.0, 0.75, 0.0, 0.0])
    assert history.corners(99.0) == (10.0,)
    assert history.corners(9.0) == ()


def test_a_duty_cycle_goes_on():
    """
    requirement: duty cycles: constant before the first instant, then again and again.

    The period is 4 s; the speed drops from 3 s to 4 s and comes back until 5 s.
    """
    history = tw.load(tables(RUNNING_IN, {SPEED: DUTY})).motion.history.function
    for cycle in range(4):
        found = [history.at(4 * cycle + t) for t in (1.0, 2.0, 3.25, 4.0, 4.5, 5.0)]
        assert found == pytest.approx([1, 1, 0.75, 0, 0.5, 1])
    assert history.at(0.0) == 1.0
    assert history.corners(12.5) == pytest.approx((1, 3, 4, 5, 7, 8, 9, 11, 12))
    assert history.corners(0.5) == ()


def test_a_load_is_its_part_of_the_largest_one():
    """
    requirement: loads by straight lines; the case's force is the largest.
    """
    case = tw.load(tables(RUNNING_IN, pressed()))
    parts = [case.load.history.loads.factor_at(t) for t in (0.0, 0.5, 1.0, 2.5, 4.0, 50.0)]
    assert case.force() == 2000.0
    assert parts == pytest.approx([0, 0.5, 1, 0.75, 0.5, 0.5])
    assert case.load.history.loads.corners(50.0) == (1.0, 4.0)


def test_a_history_whose_force_is_constant_presses_all_the_time():
    """
    requirement: a fretting history of pushes alone leaves the case's force.
    """
    assert tw.load(tables(FRETTING)).load.history.loads.factor_at(1.7) == 1.0


def test_many_cycles_have_no_corner_twice():
    """
    requirement: a step ends at each corner once, however many cycles.
    """
    third = {"time": ["0 s", "100 ms", "300 ms"], "factor": [0, 1, 0], "repeat": True}
    history = tw.load(tables(RUNNING_IN, {SPEED: third})).motion.history
    corners = history.function.corners(3000.0)
    assert len(corners) == 20_000
    assert min(b - a for a, b in pairwise(corners)) > 0.09


def test_a_lever_may_be_pressed_by_a_force_that_changes():
    """
    requirement: where only the force drives, it may change.
    """
    changes = IN_TIME | {"load": {"history": PRESS, "lever": "200 mm"}}
    assert tw.load(tables(PIVOT, changes)).force() == 2000.0
    assert tw.load(tables(STEADY, IN_TIME | {"motion.history": STOP, "heat": GONE})).motion.history
