"""Running-in of hot bodies in space: what is stored of them changes no number."""

import shutil

import numpy as np
import pytest

from thermowear.contact.operators import thermal_opening
from thermowear.laws.interfaces import Table1D
from thermowear.simulation.heat import exchange_cache
from thermowear.simulation.runtime.observer import Observer
from thermowear.simulation.system.system import System

from ..test_parallel import same_on_two_ranks
from .running_in_on_ranks import FEW, columns, running_in

SOFTENING = Table1D((293.15, 493.15), (1.0, 1.3))


class Notes(Observer):
    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


def compare(found, expected, tolerance=1e-8):
    """Compare columns of the interface, relative to their ranges."""
    for name, values in columns(expected).items():
        atol = tolerance * max(np.ptp(values), 1e-3 * np.abs(values).max())
        np.testing.assert_allclose(columns(found)[name], values, rtol=0.0, atol=atol, err_msg=name)


@pytest.mark.parametrize("expansion_factor", [None, SOFTENING], ids=["constant", "varying"])
@pytest.mark.parametrize("kind", ["quasi-steady", "in time"])
def test_the_gap_per_temperature_need_not_be_stored(monkeypatch, kind, expansion_factor):
    """
    requirement: the same running-in, to 1e-8, where the response of the gap to all temperatures is
    not stored; one line tells, with the memory that it would take.
    """
    expected, observer, made = running_in(kind, expansion_factor=expansion_factor), Notes(), []
    assert expected.stopped is None, expected.stopped
    assert expected.summary["steps"] > 3
    assert expected.summary["heat_balance_relative_error"] < 1e-10
    monkeypatch.setattr(thermal_opening, "_STORED", 0.0)
    influence = System._influence

    def noted(system):
        made.append(influence(system))
        return made[-1]

    monkeypatch.setattr(System, "_influence", noted)
    compare(running_in(kind, observer=observer, expansion_factor=expansion_factor), expected)
    assert [one.per_rise for one in made] == [()]
    (line,) = (note for note in observer.notes if note.startswith("condensation:"))
    assert "GB available" in line


@pytest.mark.parametrize("conductance", [2e4, None])
def test_exchange_of_large_faces(monkeypatch, conductance):
    """
    requirement: the same running-in, to 1e-8, where exchanges follow from a reference as points
    open and close.
    """
    expected = running_in("quasi-steady", conductance)
    monkeypatch.setattr(exchange_cache, "_FEW", 0)
    monkeypatch.setattr("thermowear.contact.operators.heat_exchange._CHANGED", 1.0)
    changed = exchange_cache.ExchangeCache._changed
    followed = []

    def noted(cache, given):
        followed.append(changed(cache, given))
        return followed[-1]

    monkeypatch.setattr(exchange_cache.ExchangeCache, "_changed", noted)
    compare(running_in("quasi-steady", conductance), expected)
    assert any(followed)
    open_points = expected.interface.pressure == 0.0
    assert open_points.any()


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")
@pytest.mark.parametrize(("kind", "conductance"), [("quasi-steady", "perfect"), ("in time", "2e4")])
def test_two_ranks(tmp_path, kind, conductance):
    """requirement: two ranks give the running-in of the serial run, to 1e-8."""
    given = None if conductance == "perfect" else float(conductance)
    expected = columns(running_in(kind, given, steps=FEW))
    module = "tests.simulation.running_in_on_ranks"
    same_on_two_ranks(module, tmp_path, expected, kind, conductance)
