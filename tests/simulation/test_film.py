"""Selection of the animation frames, which leaves the results unchanged."""

from dataclasses import astuple

import numpy as np
import pytest

import thermowear as tw
from thermowear.simulation import Observer
from thermowear.simulation.runtime.history import spacing

from ..conftest import COLD_RUNNING_IN

SMALL = ("mesh.degree=3", "mesh.elements=6", 'analysis.end_time="5 s"', "analysis.output_times=[]")


class Watcher(Observer):
    def __init__(self):
        self.frames, self.times = [], []

    def frame(self, frame):
        self.frames.append(frame)

    def row(self, row, distance):
        self.times.append(row.time)


@pytest.mark.parametrize("most", [1, 2, 7, 40])
def test_never_too_many(most):
    """requirement: evenly spaced steps, at most so many, and more than half of them once full."""
    kept = []
    for number in range(500):
        every = spacing(number, most)
        kept = [k for k in kept if k % every == 0]
        if number % every == 0:
            kept.append(number)
        assert len(kept) <= most
        assert kept[0] == 0
        assert not np.ptp(np.diff(kept)) if len(kept) > 2 else True
        if number >= most:
            assert len(kept) >= most // 2


def test_frames_are_states_of_the_run():
    """requirement: numbers and times of steps, and the fields that belong to the pressure."""
    watcher = Watcher()
    result = tw.run(tw.load(COLD_RUNNING_IN, (*SMALL, "analysis.frames=1000")), observer=watcher)
    assert [frame.number for frame in watcher.frames] == list(range(len(watcher.times)))
    assert [frame.time for frame in watcher.frames] == watcher.times
    last = watcher.frames[-1]
    assert np.array_equal(last.interface.pressure, result.interface.pressure)
    assert np.array_equal(last.interface.wear_1, result.interface.wear_1)
    np.testing.assert_array_equal(last.fields.von_mises, result.fields.von_mises)
    np.testing.assert_array_equal(last.fields.displacement, result.fields.displacement)
    first = watcher.frames[0]
    assert not first.interface.wear_1.any()
    assert np.abs(first.fields.von_mises - last.fields.von_mises).max() > 1e6


def test_watching_changes_nothing():
    """requirement: the same steps and the same numbers with and without frames."""
    without, watcher = Watcher(), Watcher()
    plain = tw.run(tw.load(COLD_RUNNING_IN, SMALL), observer=without)
    watched = tw.run(tw.load(COLD_RUNNING_IN, (*SMALL, "analysis.frames=8")), observer=watcher)
    assert without.frames == []
    numbers = [(frame.number, frame.every) for frame in watcher.frames]
    assert all(number % every == 0 for number, every in numbers)
    assert all(number // every < 8 for number, every in numbers)
    assert numbers[-1][1] > 1
    rows = [np.array([astuple(row) for row in run.history]) for run in (plain, watched)]
    np.testing.assert_array_equal(*rows)
    assert np.array_equal(plain.interface.pressure, watched.interface.pressure)


@pytest.mark.parametrize("value", ["-1", "1001", "2.5", '"many"'])
def test_a_wrong_number_is_refused(value):
    with pytest.raises(tw.CaseError, match=r"analysis\.frames"):
        tw.load(COLD_RUNNING_IN, (f"analysis.frames={value}",))


def test_reciprocating_shows_the_track(tmp_path):
    """requirement: depths of the whole track of body 2, growing from frame to frame."""
    from thermowear.case.starters import starter_text

    file = tmp_path / "case.toml"
    file.write_text(starter_text("punch-on-strip-reciprocating"), encoding="utf-8")
    small = ("mesh.degree=2", "mesh.elements=4", "analysis.positions=3", "analysis.cycles=20")
    watcher = Watcher()
    tw.run(
        tw.load(file, (*small, "analysis.output_times=[]", "analysis.frames=4")), observer=watcher
    )
    depths = [frame.track.wear_2.max() for frame in watcher.frames]
    assert depths[0] == 0.0
    assert np.all(np.diff(depths) > 0)


def test_fretting_shows_increments(tmp_path):
    """requirement: with a single cycle, its increments; the pressure follows the load."""
    from thermowear.case.starters import starter_text

    file = tmp_path / "case.toml"
    file.write_text(starter_text("cylinder-stick-slip"), encoding="utf-8")
    small = ("mesh.degree=2", "mesh.elements=8", "analysis.increments=2", "analysis.frames=100")
    watcher = Watcher()
    result = tw.run(tw.load(file, small), observer=watcher)
    rows = result.friction.rows
    assert [frame.time for frame in watcher.frames] == [row.time for row in rows]
    for frame, row in zip(watcher.frames, rows, strict=True):
        assert frame.interface.pressure.max() == pytest.approx(row.max_pressure, rel=1e-12)
