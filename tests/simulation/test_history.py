"""History of an analysis, on states without bodies."""

from contextlib import nullcontext
from dataclasses import dataclass
from types import SimpleNamespace

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.errors import ComputationError
from thermowear.model.analyses import SteppedAnalysis
from thermowear.results import HistoryRow
from thermowear.simulation import Observer
from thermowear.simulation.runtime.history import AnalysisHistory


@dataclass(frozen=True)
class Tick:
    time: float
    is_output: bool = False
    distance: float = 0.0


class Counting(AnalysisHistory[Tick]):
    """Every second state is one to restart from; some times cannot be recorded."""

    def __init__(self, system, observer, wrong=()):
        super().__init__(system, SteppedAnalysis(), observer)
        self.wrong, self.passed = wrong, 0

    def states(self, last):
        return iter(())

    def rows_of(self, state):
        if state.time in self.wrong:
            raise ComputationError("not balanced")
        self.passed += 1
        return [HistoryRow(state.time, *np.zeros(14))]

    def may_restart(self, state):
        return state.time % 2 == 0

    def restart_data(self):
        return self.passed

    def restore(self, data):
        self.passed = data

    def snapshot(self, state):
        raise AssertionError

    def summary(self):
        return {}


class Saving(Observer):
    def __init__(self):
        self.saved, self.again = [], []

    def checkpoint(self, saved):
        self.saved.append(saved.progress)

    def resumed(self, rows):
        self.again += rows


@pytest.fixture(scope="module")
def system():
    points = np.zeros((2, 2))
    return SimpleNamespace(
        model=SimpleNamespace(meshes=SimpleNamespace(path=None)),
        comm=MPI.COMM_SELF,
        phases=lambda name: nullcontext(),
        contacts=SimpleNamespace(points=points, gap=points[0]),
        ranges_by_name={},
        elastic=SimpleNamespace(nodes=lambda: points),
    )


def times(rows):
    return [row.time for row in rows]


def test_restart_points_are_saved(system):
    """requirement: rows and data up to the last state to restart from, not the ones after it."""
    observer = Saving()
    history = Counting(system, observer)
    assert history.follow(map(Tick, (0.0, 1.0, 2.0, 3.0))) is None
    assert times(history.table(HistoryRow)) == [0.0, 1.0, 2.0, 3.0]
    last = observer.saved[-1]
    assert (last.time, times(last.tables["HistoryRow"]), last.own) == (2.0, [0.0, 1.0, 2.0], 3)
    again = Saving()
    resumed = Counting(system, again)
    assert resumed.resume(last) == Tick(2.0)
    assert times(again.again) == [0.0, 1.0, 2.0]
    resumed.follow([Tick(3.0)])
    assert times(resumed.table(HistoryRow)) == [0.0, 1.0, 2.0, 3.0]
    assert resumed.passed == 4


def test_states_before_an_error_are_kept(system):
    """requirement: the last state is the one before; a first state that fails leaves nothing."""
    history = Counting(system, Saving(), wrong=(2.0,))
    stopped = history.follow(map(Tick, (0.0, 1.0, 2.0, 3.0)))
    assert str(stopped) == "not balanced"
    assert history.last == Tick(1.0)
    assert times(history.table(HistoryRow)) == [0.0, 1.0]
    with pytest.raises(ComputationError, match="not balanced"):
        Counting(system, Saving(), wrong=(0.0,)).follow([Tick(0.0)])


def test_nothing_to_resume(system):
    """requirement: a new run starts without a state."""
    assert Counting(system, Saving()).resume(None) is None
