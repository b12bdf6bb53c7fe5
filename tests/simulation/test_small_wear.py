"""Wear that stays in the gap although it is not small."""

import pytest

import thermowear as tw
from thermowear.simulation import Observer

from ..case.starter import FRETTING, RECIPROCATING, solved, tables

SMALL = ("mesh.degree=2", "mesh.elements=8", "wear.cycles=20", "analysis.output_times=[]")
PER_PRESSURE = {"coefficient": "1e-5 1/MPa", "per": "pressure"}
STROKES = {"analysis": {"type": "reciprocating", "positions": 4}, "wear": {"punch": PER_PRESSURE}}
HEIGHT = 0.01  # of the punch, thinner than the strip
RADIUS = 6e-3  # of the cylinder
TURNS = {
    "load.history": {
        "time": [f"{t} s" for t in range(5)],
        "tangential_displacement": ["0 um", "10 um", "0 um", "-10 um", "0 um"],
    },
    "wear": {"cylinder": PER_PRESSURE | {"coefficient": "1e-3 1/MPa"}},
    "analysis.increments": 4,
}


class Listening(Observer):
    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


def told(name, changes, *overrides):
    """Notes of a run on its wear, and its result."""
    listening = Listening()
    result = solved(name, changes, *SMALL, *overrides, observer=listening)
    assert result.stopped is None
    return [note for note in listening.notes if "the wear" in note], result


def test_strokes_that_wear_deep():
    """requirement: one note at the end, with how much wear there is against the height."""
    (note,), result = told(RECIPROCATING, STROKES, "analysis.tolerance=1e-2", "wear.cycles=30")
    depth = result.interface.wear_1.max()
    assert f"comes to {depth / HEIGHT:.2%} of the thickness" in note
    assert "a reciprocating analysis keeps in the gap" in note
    assert "up to 1.00%" in note
    shallow, result = told(RECIPROCATING, STROKES, "analysis.tolerance=1e-2", "wear.cycles=10")
    assert 1e-3 * HEIGHT < result.interface.wear_1.max() < 1e-2 * HEIGHT
    assert shallow == []


@pytest.mark.slow
def test_fretting_that_wears_deep():
    """requirement: the wear is held against the radius of the cylinder; nothing where it may be."""
    (note,), result = told(FRETTING, TURNS)
    assert "a fretting analysis keeps in the gap" in note
    assert f"comes to {result.interface.wear_1.max() / RADIUS:.2%} of" in note
    assert told(FRETTING, TURNS, "wear.update=never")[0] == []


@pytest.mark.parametrize(("name", "changes"), [(FRETTING, TURNS), (RECIPROCATING, STROKES)])
def test_meshes_are_not_moved(name, changes):
    """requirement: sizes of updates are refused by the key's path where nothing is updated."""
    with pytest.raises(
        tw.CaseError, match=r"^wear.update: geometry updates are not supported in a"
    ):
        tw.load(tables(name, changes), (*SMALL, "wear.update=0.01"))
    assert tw.load(tables(name, changes), (*SMALL, "wear.update=never")).wear.update == "never"
