"""Contacts in which nothing touches at the end."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import ComputationError
from thermowear.simulation.analyses.checks import open_contact, too_hot
from thermowear.simulation.runtime.observer import Observer

from ..case.starter import HERTZ, tables
from ..systems import prepared


class Notes(Observer):
    def __init__(self):
        self.texts = []

    def note(self, text):
        self.texts.append(text)


def punch(**load):
    changes = {"mesh.degree": 2, "mesh.elements": 4, "load": load, "geometry.half": False}
    changes["contact.positioning"] = False
    return tw.load(tables(HERTZ, changes))


def test_a_beam_that_does_not_touch_is_said():
    """
    requirement: pressure 0 never leaves without a word.
    """
    notes = Notes()
    changes = {"geometry.gap": "5 mm", "mesh.degree": 2, "mesh.elements": 8}
    assert tw.run(tw.load(tables("beam-on-foundation", changes)), observer=notes).stopped is None
    assert any(text.startswith("nothing touches at the end") for text in notes.texts)


@pytest.fixture(scope="module")
def apart():
    """A system, and an interface of it that has no pressure."""
    from mpi4py import MPI

    from thermowear.simulation.analyses.static import initial

    def made(case):
        system = prepared(case, MPI.COMM_SELF)
        _, result = initial(system, Observer())
        nothing = np.zeros(len(system.weights))
        return system, replace(result.interface, pressure=nothing, gap=nothing + 2e-6)

    return made


def test_a_given_approach_may_leave_the_faces_apart(apart):
    """
    requirement: said, with how far they are apart.
    """
    note = open_contact(*apart(punch(approach="0.05 mm")))
    assert note == "nothing touches at the end; the faces are 2 µm apart at least"


def test_a_pressing_force_has_to_be_carried(apart):
    """
    requirement: a force that nothing carries is a failed computation, results kept.
    """
    error = open_contact(*apart(punch(force="1 kN")))
    assert isinstance(error, ComputationError)
    assert str(error).startswith("nothing carries the pressing force of 1000 N")


def test_temperatures_of_no_solid():
    """requirement: a highest temperature beyond all solids is noted, at the end or before it."""
    assert too_hot({}) is too_hot({"max_temperature_K": None}) is None
    assert too_hot({"max_temperature_K": 2000.0, "peak_temperature_K": 3200.0}) is None
    found = too_hot({"max_temperature_K": 400.0, "peak_temperature_K": 5273.15})
    assert found is not None
    assert found.startswith("highest temperature 5000 °C: beyond the melting point")


@pytest.mark.slow
def test_a_load_that_melts_the_bodies_is_noted():
    """requirement: the note reaches the observer of a run."""
    notes = Notes()
    case = tw.load(tables(), ("mesh.degree=2", "mesh.elements=4", "load.mean_pressure=5 GPa"))
    tw.run(case, observer=notes)
    assert any("beyond the melting point" in text for text in notes.texts)
