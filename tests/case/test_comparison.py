"""What may change where a run goes on."""

import pytest

import thermowear as tw
from thermowear.case.comparison import different_keys, forbidden_changes, irrelevant_changes_only

from ..conftest import COLD_RUNNING_IN, DEMOS

STROKES = DEMOS / "punch_on_strip_reciprocating.toml"  # 2000 cycles at 2 Hz; 10 s, 100 s
TUBE = DEMOS / "tube_in_support.toml"  # 100 000 cycles; 1000 s, 2500 s


def changed(path, *overrides, time, before=()):
    return forbidden_changes(tw.load(path, before), tw.load(path, (*before, *overrides)), time)


def test_keys_are_named_with_their_tables():
    """requirement: defaults are written out, and text is compared in SI."""
    one = tw.load(COLD_RUNNING_IN)
    assert different_keys(one, one) == []
    same = tw.load(COLD_RUNNING_IN, ("load.mean_pressure=0.05 GPa", "contact.method=condensed"))
    assert different_keys(one, same) == []
    other = tw.load(COLD_RUNNING_IN, ("wear.punch.coefficient=1e-7 1/MPa", "mesh.degree=3"))
    assert sorted(different_keys(one, other)) == ["mesh.degree", "wear.punch.coefficient"]


@pytest.mark.parametrize(
    ("path", "change", "time", "allowed"),
    [
        (COLD_RUNNING_IN, "title=Other", 150.0, True),
        (COLD_RUNNING_IN, "analysis.max_steps=7", 150.0, True),
        (COLD_RUNNING_IN, "analysis.checkpoint_every=1 h", 150.0, True),
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
        (TUBE, "analysis.cycles=200000", 1500.0, False),  # the last jump depends on it
    ],
)
def test_only_what_lies_ahead_may_change(path, change, time, allowed):
    """requirement: physics and what has passed stay; the end and output times may come later."""
    found = changed(path, change, time=time)
    assert found == ([] if allowed else [change.partition("=")[0]])


def test_only_settings_that_change_no_number_are_irrelevant():
    one = tw.load(COLD_RUNNING_IN)
    assert irrelevant_changes_only(one, tw.load(COLD_RUNNING_IN, ("title=Other",)))
    assert not irrelevant_changes_only(one, tw.load(COLD_RUNNING_IN, ("analysis.end_time=3 h",)))
