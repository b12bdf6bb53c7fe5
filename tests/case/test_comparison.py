"""Changes that are allowed when a run is resumed."""

import pytest

import thermowear as tw
from thermowear.case.validation.comparison import (
    changes,
    forbidden_changes,
    irrelevant_changes_only,
)

from ..conftest import COLD_RUNNING_IN, DEMOS

STROKES = DEMOS / "punch_on_strip_reciprocating.toml"  # 2000 cycles at 2 Hz; 10 s, 100 s
TUBE = DEMOS / "tube_in_support.toml"  # 100 000 cycles; 1000 s, 2500 s


def keys(found):
    return [change.key for change in found]


def test_keys_are_named_with_their_tables():
    """requirement: defaults are written out, and text is compared in SI."""
    one = tw.load(COLD_RUNNING_IN)
    assert changes(one, one) == []
    same = tw.load(COLD_RUNNING_IN, ("load.mean_pressure=0.05 GPa", "contact.method=condensed"))
    assert changes(one, same) == []
    other = tw.load(COLD_RUNNING_IN, ("wear.punch.coefficient=1e-7 1/MPa", "mesh.degree=3"))
    assert keys(changes(one, other)) == ["mesh.degree", "wear.punch.coefficient"]


@pytest.mark.parametrize(
    ("path", "change", "time", "allowed"),
    [
        (COLD_RUNNING_IN, "title=Other", 150.0, True),
        (COLD_RUNNING_IN, "analysis.max_steps=7", 150.0, True),
        (COLD_RUNNING_IN, "analysis.checkpoint_every=1 h", 150.0, True),
        (COLD_RUNNING_IN, "analysis.frames=40", 150.0, True),
        (COLD_RUNNING_IN, "analysis.end_time=300 s", 150.0, True),
        (COLD_RUNNING_IN, "analysis.end_time=160 s", 150.0, True),
        (COLD_RUNNING_IN, "analysis.end_time=120 s", 150.0, False),
        (COLD_RUNNING_IN, "analysis.output_times=['1 s', '5 s', '60 s']", 10.0, True),
        (COLD_RUNNING_IN, "analysis.output_times=['1 s', '5 s', '60 s']", 30.0, False),
        (COLD_RUNNING_IN, "analysis.tolerance=1e-5", 0.0, False),
        (COLD_RUNNING_IN, "analysis.until=steady", 0.0, False),
        (COLD_RUNNING_IN, "contact.friction=0.26", 0.0, False),
        (STROKES, "analysis.cycles=3000", 900.0, True),
        (STROKES, "analysis.cycles=1900", 900.0, True),
        (STROKES, "analysis.cycles=1700", 900.0, False),
        (STROKES, "analysis.positions=13", 0.0, False),
        (TUBE, "analysis.output_times=['1000 s', '3000 s']", 1500.0, True),
        (TUBE, "analysis.output_times=['1000 s', '3000 s']", 2500.0, False),
        (TUBE, "analysis.cycles=200000", 1500.0, True),
        (TUBE, "analysis.cycles=57000", 2800.0, True),
        (TUBE, "analysis.cycles=55000", 2800.0, False),
        (TUBE, "analysis.increments=21", 0.0, False),
        (TUBE, "analysis.jump=1000", 0.0, False),
    ],
)
def test_only_what_lies_ahead_may_change(path, change, time, allowed):
    """requirement: physics and what has passed stay; the end and output times may come later."""
    found = forbidden_changes(tw.load(path), tw.load(path, (change,)), time)
    assert keys(found) == ([] if allowed else [change.partition("=")[0]])


def test_changes_are_shown_with_both_values():
    """requirement: what the key was and what it is, in one line, however long."""
    one = tw.load(COLD_RUNNING_IN)
    (found,) = changes(one, tw.load(COLD_RUNNING_IN, ("contact.friction=0.3",)))
    assert str(found) == "contact.friction was 0.25, is now 0.3"
    times = str([f"{number} s" for number in range(1, 100)])
    (found,) = changes(one, tw.load(COLD_RUNNING_IN, (f"analysis.output_times={times}",)))
    assert str(found).startswith("analysis.output_times was ('1.0 s', '5.0 s', ")
    assert len(str(found)) < 160
    start = changes(tw.load(TUBE), tw.load(TUBE, ("load.history.cycle_start=0 ms",)))
    assert [str(change) for change in start] == [
        "load.history.cycle_start was not given, is now 0.0 s"
    ]


def test_only_settings_that_change_no_number_are_irrelevant():
    one = tw.load(COLD_RUNNING_IN)
    assert irrelevant_changes_only(one, tw.load(COLD_RUNNING_IN, ("title=Other",)))
    assert not irrelevant_changes_only(one, tw.load(COLD_RUNNING_IN, ("analysis.end_time=3 h",)))
